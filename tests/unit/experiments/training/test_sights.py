"""Where a point of one panorama is in another: in a room of which every range is known."""

import math

import numpy as np
import pytest

from experiments.training.correspondences import correspondences
from experiments.training.sights import CameraPose, Sight, projected
from shared.geometry.sphere import bearings_from_lonlat, lonlat_from_bearings
from simulator.sensors.panorama import directions

HALF_M, WIDTH = np.array([4.0, 3.0, 2.0]), 512


def in_a_box(pose: CameraPose, hidden: bool = False) -> Sight:
    """What a camera sees in an empty box round the origin; if hidden, something stands before everything."""
    rays = directions(WIDTH) @ pose.rotation.T
    with np.errstate(divide="ignore"):
        ways = (np.where(rays > 0, HALF_M, -HALF_M) - pose.position_m) / rays
    ranges = np.nanmin(np.where(ways > 0, ways, np.inf), axis=-1)
    return Sight(np.zeros((WIDTH // 2, WIDTH, 3), np.uint8), 0.3 * ranges if hidden else ranges, pose)


HERE = CameraPose(0.5, 0.2, 0.3, 0.1)
THERE = CameraPose(-1.0, 1.0, -2.0, 0.15, (0.05, -0.03))


def test_a_point_on_a_wall_is_found_where_the_other_camera_sees_it():
    here, there = in_a_box(HERE), in_a_box(THERE)
    point = np.array([4.0, -1.0, 0.7])
    lonlat = [lonlat_from_bearings((point - pose.position_m) @ pose.rotation) for pose in (HERE, THERE)]
    found, visible = projected(lonlat[0][None], here, there)
    assert visible.all()
    off = np.arccos(bearings_from_lonlat(found[0]) @ bearings_from_lonlat(lonlat[1]))
    assert off < math.radians(0.5)  # a pixel is 0.7 degrees wide


def test_what_is_hidden_is_not_seen():
    directions_rad = np.array([[0.0, 0.0], [2.0, 0.3]])
    assert projected(directions_rad, in_a_box(HERE), in_a_box(THERE))[1].all()
    assert not projected(directions_rad, in_a_box(HERE), in_a_box(THERE, hidden=True))[1].any()


def test_where_nothing_is_nothing_recurs():
    here, there = in_a_box(HERE), in_a_box(THERE)
    empty = Sight(here.picture, np.full_like(here.ranges_m, np.inf), here.pose)
    assert not projected(np.zeros((3, 2)), empty, there)[1].any()


def test_partners_are_one_to_one_and_wrong_matches_are_told():
    here, there = in_a_box(HERE), in_a_box(THERE)
    first = np.array([[0.1, 0.1], [1.5, -0.2], [-2.0, 0.3]])
    expected, _ = projected(first, here, there)
    second = np.concatenate([expected[[2, 0]], expected[[0]] + math.radians(0.5), [[0.0, 1.0]]])
    truth = correspondences(first, second, here, there)
    assert truth.pairs.tolist() == [[0, 1], [2, 0]]
    assert truth.right(np.array([[0, 1], [0, 3], [2, 0], [1, 0]])).tolist() == [True, False, True, False]


@pytest.mark.parametrize("count", [0, 3])
def test_no_keypoints_are_no_error(count):
    truth = correspondences(np.zeros((count, 2)), np.zeros((0, 2)), in_a_box(HERE), in_a_box(THERE))
    assert truth.pairs.shape == (0, 2)
    assert not truth.recurring.any()
