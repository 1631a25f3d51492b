"""The main job, small: explore a little, then find a robot from its picture."""

import pytest

from services.launcher.evaluation.exploration import figures
from tests.e2e.near_node import hiding_place_near_a_node

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]


def test_what_was_explored_is_true(explored):
    report = figures(explored.result, explored.space, "small", 1)
    assert report["nodes"] >= 5
    assert report["components"] == 1
    assert report["coverage"] > 0.1
    assert (report["false_edges"], report["collisions"], report["manual_moves"]) == (0, 0, 0)


def test_a_hidden_robot_is_found_from_its_picture(explored):
    game = explored.game
    start = game.begin(seed=1).pose
    hider = hiding_place_near_a_node(explored.result, explored.space, start)
    played = game.seek(start, hider, seed=2, max_steps=200)
    assert played.run.status.state == "succeeded", played.run.status.reason
    assert played.distance_m <= 0.5
    assert played.figures()["collisions"] == 0
    assert played.spl > 0.3
