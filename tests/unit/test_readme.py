"""What the README shows is what the repository holds and what the code accepts."""

import re

import numpy as np
import pytest

from services.features.extraction import extract
from services.features.pipelines import Profile
from services.features.registry import create_representation
from simulator.world_file import load_world
from tests.readme import README, examples

LINK = re.compile(r"\]\((?!https?:)([^)#]+)\)")


def test_links_and_pictures_lead_to_files():
    targets = LINK.findall(README.read_text(encoding="utf-8"))
    assert [target for target in targets if not (README.parent / target).exists()] == []


def test_the_errand_is_the_script_that_the_end_to_end_tests_run(repository):
    script = (repository / "deploy/examples/goto.sh").read_text(encoding="utf-8")
    assert examples("bash")[1] == script[script.index("map=$1") :]


def test_the_world_loads(tmp_path):
    (text,) = examples("yaml")
    (tmp_path / "studio.yaml").write_text(text, encoding="utf-8")
    world = load_world(str(tmp_path / "studio.yaml"))
    assert [item.kind for item in world.furniture] == ["bookshelf", "picture", "ceiling_light"]


def test_the_extractor_works_as_a_plugin():
    (source,) = examples("python")
    names: dict[str, type] = {}
    exec(compile(source, "README.md", "exec"), names)
    profile = Profile("brisk", keypoints=50)
    picture = np.random.default_rng(1).integers(0, 255, (128, 256, 3), dtype=np.uint8)
    words = extract(picture, names["Brisk"](profile), create_representation(profile), profile)
    assert words.descriptors.shape == (50, 64)


@pytest.mark.parametrize("variable", re.findall(r"`(TOPNAV_[A-Z_]+)`", README.read_text(encoding="utf-8")))
def test_the_settings_named_exist(repository, variable):
    places = [repository / "docker-compose.yml", *(repository / "services/launcher").glob("*.py")]
    assert any(variable in place.read_text(encoding="utf-8") for place in places)
