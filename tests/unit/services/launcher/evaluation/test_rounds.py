"""Where a robot may hide, and when a round counts as a success."""

import math

import numpy as np
import pytest

from services.launcher.client.mission import MissionRun
from services.launcher.evaluation.rounds import MIN_APART_M, Round, hiding_place
from shared.messages import Frame, MissionStatus, Truth
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

START = Pose(x_m=2.6, y_m=1.3, yaw_rad=0.0)


@pytest.fixture(scope="module")
def space():
    return free_space(load_world("apartment"))


def played(state, final_x_m, way=((0.0, 0), (1.0, 1))):
    truths = [
        Truth(seq=s, stamp_ns=s, robot="r1", world="w", pose=Pose(x_m=x, y_m=0.0, yaw_rad=0.0))
        for x, s in way
    ]
    status = MissionStatus(robot="r1", state=state, step=7, failure="lost" if state == "failed" else "")
    hider = Pose(x_m=1.0, y_m=0.0, yaw_rad=0.0)
    final = Pose(x_m=final_x_m, y_m=0.0, yaw_rad=0.0)
    goal = Frame(robot="r1", encoding="bgr8", width_px=2, height_px=1, data=bytes(6))
    return Round(START, hider, final, goal, MissionRun(status, truths, 2.0), 0.8, 0)


def test_hiding_places_are_free_far_enough_and_repeatable(space):
    places = [hiding_place(space, START, np.random.default_rng(5)) for _ in range(2)]
    assert places[0] == places[1]
    rng = np.random.default_rng(6)
    for _ in range(10):
        pose = hiding_place(space, START, rng)
        way_m = space.shortest_path_m((START.x_m, START.y_m), (pose.x_m, pose.y_m))
        assert space.is_free((pose.x_m, pose.y_m))
        assert way_m >= MIN_APART_M
        assert way_m >= math.hypot(pose.x_m - START.x_m, pose.y_m - START.y_m) - 0.1


@pytest.mark.parametrize(
    ("state", "final_x_m", "success"),
    [("succeeded", 1.4, True), ("succeeded", 1.6, False), ("failed", 1.0, False)],
)
def test_success_needs_both_the_planner_and_the_truth(state, final_x_m, success):
    assert played(state, final_x_m).success is success


def test_figures_have_the_fixed_keys_and_say_why_it_failed():
    figures = played("failed", 3.0).figures()
    assert {"success", "final_distance_m", "spl", "steps", "collisions", "reason"} <= figures.keys()
    assert figures["spl"] == 0.0
    assert str(figures["reason"]).startswith("lost")
    assert played("succeeded", 3.0).figures()["failure"] == "wrong_place"
    assert played("succeeded", 1.0).spl == pytest.approx(0.8)
