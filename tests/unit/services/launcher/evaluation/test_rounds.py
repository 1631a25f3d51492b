"""Where a robot may hide."""

import math

import numpy as np
import pytest

from services.launcher.evaluation.rounds import MIN_APART_M, hiding_place
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

START = Pose(x_m=2.6, y_m=1.3, yaw_rad=0.0)


@pytest.fixture(scope="module")
def space():
    return free_space(load_world("apartment"))


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
