"""What stands around a node tells it from spots that look the same, in whatever direction the robot looks."""

import math

import numpy as np
import pytest

from services.planner.echoes import DIFFERING_MAX, by_sector_m, is_elsewhere
from shared.mapgraph.frontiers import SECTOR_RAD
from shared.messages.maps import Node
from shared.messages.sensors import Ranges

SECTOR_ANGLES_RAD = tuple(SECTOR_RAD * sector for sector in range(12))
AROUND_M = (3.0, 2.6, 2.2, 1.0, 0.8, 1.0, 2.4, 2.9, 3.0, 1.7, 1.5, 1.7)


def read(distances_m, angles_rad=SECTOR_ANGLES_RAD):
    return Ranges(robot="r1", angles_rad=angles_rad, distances_m=tuple(distances_m), max_range_m=4.0)


def node(echoes_m=AROUND_M):
    return Node(node_id=0, echoes_m=echoes_m)


def changed(count, by_m=1.5):
    return [echo_m + (by_m if sector < count else 0.0) for sector, echo_m in enumerate(AROUND_M)]


def test_a_sector_has_the_reading_nearest_to_its_middle_and_at_most_the_range():
    angles_rad = [math.remainder(angle + math.pi + 0.1, math.tau) for angle in SECTOR_ANGLES_RAD]
    found = by_sector_m(read([9.0, *(n / 8 for n in range(1, 12))], angles_rad))
    assert found == (*(n / 8 for n in range(6, 12)), 4.0, *(n / 8 for n in range(1, 6)))


def test_the_readings_of_the_spot_itself_agree():
    assert not is_elsewhere(node(), read(AROUND_M), 0.0)


@pytest.mark.parametrize("turn", range(12))
def test_a_robot_that_stands_there_turned_reads_the_same_things_elsewhere(turn):
    there = read(np.roll(AROUND_M, turn))
    assert not is_elsewhere(node(), there, turn * SECTOR_RAD)
    if turn in (3, 9):
        assert is_elsewhere(node(), there, 0.0)


@pytest.mark.parametrize("by_m", [1.5, -0.75])
def test_only_so_many_readings_may_differ(by_m):
    wide = node((1.4,) * 12)
    for count in range(13):
        there = read([1.4 + (by_m * 1.4 if sector < count else 0.0) for sector in range(12)])
        assert is_elsewhere(wide, there, 0.0) == (count > DIFFERING_MAX)


def test_a_little_off_is_still_the_spot_and_far_things_may_differ_by_more():
    assert not is_elsewhere(node(), read(changed(12, 0.5)), 0.0)
    far = node((3.0,) * 12)
    assert not is_elsewhere(far, read((3.8,) * 12), 0.0)
    assert is_elsewhere(node((0.5,) * 12), read((1.3,) * 12), 0.0)


def test_a_node_of_before_contradicts_nothing():
    assert not is_elsewhere(node(None), read((0.3,) * 12), 0.0)
