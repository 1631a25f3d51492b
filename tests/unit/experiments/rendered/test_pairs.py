"""Pose pairs: distance, sight, and the true heading and turn."""

import math

import numpy as np
import pytest

from experiments.rendered.pairs import APART_M, PosePair, draw_pairs
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world


def test_pairs_are_near_enough_and_see_each_other():
    space = free_space(load_world("apartment"))
    for pair in draw_pairs(space, 15, np.random.default_rng(1)):
        ends = [(p.x_m, p.y_m) for p in (pair.current, pair.target)]
        assert APART_M[0] <= pair.distance_m <= APART_M[1]
        assert all(space.is_free(end) for end in ends)
        assert space.line_of_sight(*ends)


def test_heading_and_yaw_are_in_the_frame_of_the_first_camera():
    pair = PosePair(Pose(x_m=1, y_m=1, yaw_rad=math.pi / 2), Pose(x_m=0, y_m=1, yaw_rad=-math.pi))
    assert pair.heading_rad == pytest.approx(math.pi / 2)  # it looks along y, the other is at its left
    assert pair.yaw_rad == pytest.approx(math.pi / 2)
