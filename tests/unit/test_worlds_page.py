"""The page about world files: its example works and its tables are up to date."""

import re
from pathlib import Path

import pytest

from simulator.world.world_check import examine
from simulator.world.world_file import load_world
from simulator.world.world_reference import renewed

PAGE = Path(__file__).parents[2] / "deploy" / "WORLDS.md"


def test_example_of_the_page_has_no_faults(tmp_path):
    example = re.findall(r"```yaml\n(format:.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "two_rooms.yaml").write_text(example[0], encoding="utf-8")
    report = examine(load_world(str(tmp_path / "two_rooms.yaml")))
    assert report.faults == ()
    assert report.doubts == ()
    assert report.unreachable == ()
    assert [passage.width_m for passage in report.passages] == pytest.approx([1.2], abs=0.05)


def test_tables_are_those_of_the_code():
    page = PAGE.read_text(encoding="utf-8")
    assert renewed(page) == page, "run: topnav world kinds --into deploy/WORLDS.md"
