"""A suite maps a world it has never seen, plays its rounds, and goes on where it was cut off."""

import json
import subprocess
import sys

import pytest

from tests.e2e.closet import CLOSET

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(1200)]


def play(repository, folder):
    options = ("--suite", "random", "--worlds", str(folder / "closet.yaml"), "--rounds", "2", "--seed", "1")
    files = ("--json", str(folder / "suite.json"), "--data-dir", str(folder / "data"))
    command = [sys.executable, "-m", "services.launcher", "hide-and-seek", *options, *files]
    answer = subprocess.run(command, cwd=repository, capture_output=True, text=True, timeout=500)
    assert answer.returncode == 0, answer.stderr
    return json.loads((folder / "suite.json").read_text())


def test_a_suite_runs_from_nothing_and_goes_on_where_it_was_cut_off(repository, tmp_path):
    (tmp_path / "closet.yaml").write_text(CLOSET)
    first = play(repository, tmp_path)
    assert {"suite", "runs", "summary", "maps"} <= first.keys()
    assert first["summary"]["default"]["rounds"] == 2
    assert first["maps"][0]["coverage"] > 0.9
    assert {"render", "extract", "match"} <= first["runs"][0]["stages"].keys()
    assert first["runs"][0]["memory_mb"]["features"] > 50.0
    suites = tmp_path / "data" / "suites"
    assert "closet" in (suites / "random-1.md").read_text()
    folder = suites / "random" / "closet-default-1"
    assert (folder / "round-02" / "path.png").stat().st_size > 1000

    record = folder / "rounds.json"
    cut = json.loads(record.read_text())
    cut["rounds"] = cut["rounds"][:1]
    record.write_text(json.dumps(cut))
    again = play(repository, tmp_path)
    assert again["runs"][0]["rounds"][0] == first["runs"][0]["rounds"][0]
    hiders = [run["runs"][0]["rounds"][1]["hider"] for run in (first, again)]
    assert hiders[0] == pytest.approx(hiders[1], abs=1e-6)
    assert again["maps"] == first["maps"], "the map was not made again"
