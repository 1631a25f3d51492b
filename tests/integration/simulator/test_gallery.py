"""The page of generated worlds, with real pictures."""

from itertools import islice

import cv2
import pytest
from typer.testing import CliRunner

from services.launcher.commands.assets.world import app
from simulator.generation.splits import worlds_of
from simulator.world.world_file import load_world

pytestmark = pytest.mark.render


def test_the_page_shows_plan_and_panorama_of_each_world(tmp_path):
    result = CliRunner().invoke(app, ["gallery", "--into", str(tmp_path), "--count", "2"])
    assert result.exit_code == 0, result.output
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    for kind, seed, size in islice(worlds_of({"development", "validation"}), 2):
        name = f"{kind}-{seed}-{size}"
        assert f'src="{name}.png"' in page
        assert cv2.imread(str(tmp_path / f"{name}.jpg")).std() > 20
        assert cv2.imread(str(tmp_path / f"{name}.png")).std() > 20
        assert load_world(str(tmp_path / f"{name}.yaml")).generated.kind == kind
