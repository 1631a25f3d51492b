"""`topnav world`: what it prints, writes and returns."""

import copy
import json
from pathlib import Path

import pytest
import yaml
from typer.testing import CliRunner

from services.launcher.commands.assets.world import app
from simulator.world.world_file import WorldFileError, load_world

GAZEBO = Path(__file__).resolve().parents[6] / "deploy/examples/gazebo/two_rooms.world"
MODELS = GAZEBO.parent / "models"
PAINT = {"texture": "lacquer", "colour": [200, 200, 200]}
WORLD = {
    "format": "topnav-world/1",
    "name": "cell",
    "start": {"x_m": 2.0, "y_m": 2.0},
    "rooms": [
        {"name": "room", "x_m": [0, 5], "y_m": [0, 4], "floor": PAINT, "walls": PAINT, "ceiling": PAINT}
    ],
    "furniture": [{"kind": "ceiling_light", "at_m": [2, 2], "z_m": 2.6}],
}


def check(folder, *arguments, **changes):
    file = folder / "cell.yaml"
    file.write_text(yaml.safe_dump({**copy.deepcopy(WORLD), **changes}), encoding="utf-8")
    return CliRunner().invoke(app, ["check", str(file), *map(str, arguments)])


def test_sound_world_is_described_and_drawn(tmp_path):
    result = check(tmp_path, "--plan", tmp_path / "plan.png", "--json", tmp_path / "cell.json")
    assert result.exit_code == 0
    assert "5 x 4 m" in result.output
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    figures = json.loads((tmp_path / "cell.json").read_text(encoding="utf-8"))
    assert figures["floor_m2"] == 20.0
    assert figures["faults"] == []


def test_fault_is_printed_and_makes_the_exit_status_1(tmp_path):
    result = check(tmp_path, start={"x_m": 0.1, "y_m": 1.0})
    assert result.exit_code == 1
    assert "a wall is 0.10 m away" in " ".join(result.output.split())


def test_world_that_does_not_load_raises_what_the_launcher_prints(tmp_path):
    result = check(tmp_path, rooms=[])
    assert isinstance(result.exception, WorldFileError)


def test_kinds_lists_furniture_and_renews_a_page(tmp_path):
    assert "| `sofa` |" in CliRunner().invoke(app, ["kinds"]).output
    page = tmp_path / "page.md"
    page.write_text(
        "before\n<!-- begin: topnav world kinds -->\noutdated\n<!-- end: topnav world kinds -->\nafter\n"
    )
    CliRunner().invoke(app, ["kinds", "--into", str(page)])
    text = page.read_text(encoding="utf-8")
    assert text.startswith("before\n")
    assert text.endswith("after\n")
    assert "`sofa`" in text
    assert "outdated" not in text


def test_page_without_marks_is_refused(tmp_path):
    (tmp_path / "page.md").write_text("nothing")
    result = CliRunner().invoke(app, ["kinds", "--into", str(tmp_path / "page.md")])
    with pytest.raises(ValueError, match="must have the lines"):
        raise result.exception


def generate(*arguments):
    return CliRunner().invoke(app, ["generate", *map(str, arguments)])


def test_a_generated_world_is_a_file_like_any_other(tmp_path):
    file = tmp_path / "new" / "yard.yaml"
    result = generate("--kind", "yard", "--seed", 1, "--size", "small", "--into", file)
    assert result.exit_code == 0
    assert "split " + load_world(str(file)).generated.split in result.output
    assert CliRunner().invoke(app, ["check", str(file)]).exit_code == 0


def test_a_kind_that_there_is_not_leaves_no_file(tmp_path):
    file = tmp_path / "castle.yaml"
    result = generate("--kind", "castle", "--seed", 1, "--into", file)
    assert "kind must be one of flat" in str(result.exception)
    assert not file.exists()


def test_a_generated_world_needs_the_name_of_a_world_file(tmp_path):
    result = generate("--kind", "flat", "--seed", 1, "--into", tmp_path / "flat.txt")
    assert "--into must end in .yaml" in str(result.exception)


def test_world_of_others_is_imported_described_and_ready_to_explore(tmp_path):
    into = tmp_path / "house"
    result = CliRunner().invoke(
        app, ["import", str(GAZEBO), "--into", str(into), "--start", "1", "1.2", "90"]
    )
    assert result.exit_code == 0
    said = " ".join(result.output.split())
    assert "world two_rooms" in said
    assert f"next: topnav explore --world {into}/house.yaml --map house" in said
    start = load_world(str(into / "house.yaml")).start
    assert (start.x_m, start.y_m, start.yaw_deg) == (1.0, 1.2, 90.0)


def test_what_could_not_be_shown_of_an_imported_world_is_said(tmp_path):
    text = GAZEBO.read_text(encoding="utf-8").replace("model://chair<", "model://stool<")
    (tmp_path / "w.world").write_text(text, encoding="utf-8")
    arguments = ["import", str(tmp_path / "w.world"), "--into", str(tmp_path / "w"), "--models", str(MODELS)]
    assert "model://stool" in str(CliRunner().invoke(app, arguments).exception)
    result = CliRunner().invoke(app, [*arguments, "--leave-out"])
    assert result.exit_code == 0
    assert "note" in result.output
    assert "model://stool" in result.output
