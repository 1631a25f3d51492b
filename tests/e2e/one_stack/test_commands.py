"""The command line against a running stack: it joins, and what cannot be done is one clear line."""

import json
import math
import subprocess
import sys

import pytest

from services.launcher.drawing.pictures import save_picture
from shared.mapgraph.triangle import DIRECTION_RAD, YAW_RAD
from tests.e2e.near_node import hiding_place_near_a_node

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]


def topnav(explored, repository, *arguments):
    command = [sys.executable, "-m", "services.launcher", *arguments, "--data-dir", str(explored.data_dir)]
    return subprocess.run(command, cwd=repository, capture_output=True, text=True, timeout=300)


REFUSALS = [
    pytest.param(("explore", "--map", "small"), "exists with", id="a map that exists"),
    pytest.param(("explore", "--map", "x", "--profile", "thesis"), "--profile cannot change", id="profile"),
    pytest.param(("hide-and-seek", "--map", "nowhere", "--no-draw"), "no map 'nowhere'", id="no such map"),
    pytest.param(("explore", "--world", "moon"), "moon", id="no such world"),
]


@pytest.mark.parametrize(("arguments", "text"), REFUSALS)
def test_what_cannot_be_done_is_one_line_and_a_failure(explored, repository, arguments, text):
    answer = topnav(explored, repository, *arguments)
    assert answer.returncode == 1
    assert text in answer.stderr
    assert len(answer.stderr.strip().splitlines()) == 1, answer.stderr


def test_goto_joins_the_stack_and_arrives(explored, repository, tmp_path):
    game = explored.game
    start = game.begin(seed=1).pose
    hider = hiding_place_near_a_node(explored.result, explored.space, start)
    save_picture(tmp_path / "goal.png", game.hide(hider))
    figures = tmp_path / "goto.json"
    arguments = ("--map", "small", "--image", str(tmp_path / "goal.png"), "--json", str(figures))
    answer = topnav(explored, repository, "goto", *arguments)
    assert answer.returncode == 0, answer.stderr
    assert json.loads(figures.read_text())["success"] is True


def test_hide_and_seek_writes_the_fixed_keys_and_the_drawings(explored, repository, tmp_path):
    figures = tmp_path / "rounds.json"
    options = ("--rounds", "1", "--seed", "3", "--max-steps", "40", "--json", str(figures))
    topnav(explored, repository, "hide-and-seek", "--map", "small", *options, "--drawings", str(tmp_path))
    report = json.loads(figures.read_text())
    assert {"world", "profile", "seed", "rounds", "summary"} <= report.keys()
    assert {"success", "final_distance_m", "spl", "steps", "collisions", "reason"} <= report["rounds"][
        0
    ].keys()
    wanted = {"rounds", "success_rate", "collisions", "manual_moves", "spl_mean", "final_distance_median_m"}
    assert {*wanted, "steps_per_s"} <= report["summary"].keys()
    for name in ("path.png", "goal.png", "seeker_final.png", "hider_final.png"):
        assert (tmp_path / "round-01" / name).stat().st_size > 1000


def test_the_triangles_of_a_map_close_within_the_tolerances_of_cycle_consistency(
    explored, repository, tmp_path
):
    figures = tmp_path / "cycles.json"
    answer = topnav(explored, repository, "study", "cycles", "--map", "small", "--json", str(figures))
    assert answer.returncode == 0, answer.stderr
    report = json.loads(figures.read_text())
    assert report["triangles"] > 5
    most = {row["miss"]: math.radians(row["p100_deg"]) for row in report["misses"]}
    assert 0.0 < most["yaw"] < YAW_RAD
    assert 0.0 < most["direction"] < DIRECTION_RAD
