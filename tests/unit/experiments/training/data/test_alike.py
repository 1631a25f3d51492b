"""Places that are not the same: they do not see each other, and half of them are twins where rooms are."""

import math

import numpy as np
import pytest

from experiments.training.data.alike import APART_M, SAME_M, draw_strangers
from experiments.training.worlds import WorldName
from simulator.world.freespace import free_space


@pytest.fixture(scope="module")
def strangers():
    """A dormitory, whose rooms are of one size, and pairs in it."""
    world = WorldName("hostel", 0, "medium").world()
    space, rng = free_space(world), np.random.default_rng(2)
    return world, space, [draw_strangers(world, space, rng) for _ in range(30)]


def within(world, pose):
    """Room of a pose, and its distances to two of its walls."""
    for room in world.rooms:
        (x0, x1), (y0, y1) = room.x_m, room.y_m
        if x0 <= pose.x_m <= x1 and y0 <= pose.y_m <= y1:
            return room, (pose.x_m - x0, pose.y_m - y0), (x1 - pose.x_m, y1 - pose.y_m)
    return None


def test_they_are_free_apart_and_out_of_sight(strangers):
    _, space, pairs = strangers
    for pair in pairs:
        ends = [(pose.x_m, pose.y_m) for pose in (pair.current, pair.target)]
        assert all(map(space.is_free, ends))
        assert pair.distance_m >= APART_M
        assert not space.line_of_sight(*ends)


def test_many_are_the_same_spot_of_two_rooms_of_one_size(strangers):
    world, _, pairs = strangers
    twins = 0
    for pair in pairs:
        here, there = within(world, pair.current), within(world, pair.target)
        if here is None or there is None or here[0] is there[0]:
            continue
        turned = abs(pair.yaw_rad) > 1.0
        alike = math.dist(here[1], there[2] if turned else there[1]) < 2 * SAME_M
        twins += alike and min(abs(pair.yaw_rad), math.pi - abs(pair.yaw_rad)) < 1e-6
    assert twins >= len(pairs) // 4
