"""Where a point of one panorama is in another: in a room of which every range is known."""

import math

import numpy as np
import pytest

from experiments.training.correspondences import correspondences
from experiments.training.sights import CameraPose, Sight, overlap, projected
from shared.geometry.sphere import bearings_from_lonlat, lonlat_from_bearings
from tests.unit.experiments.training.boxes import in_a_box

HERE = CameraPose(0.5, 0.2, 0.3, 0.1)
THERE = CameraPose(-1.0, 1.0, -2.0, 0.15, (0.05, -0.03))


def test_a_camera_turns_leans_and_rolls_as_the_simulated_one_does():
    cos, sin = math.cos(0.1), math.sin(0.1)
    ahead = CameraPose(0.0, 0.0, math.pi / 2, 0.8, (0.1, 0.0)).rotation @ [1.0, 0.0, 0.0]
    np.testing.assert_allclose(ahead, [0.0, cos, -sin], atol=1e-12)  # towards y, nose down
    left = CameraPose(0.0, 0.0, 0.0, 0.8, (0.0, 0.1)).rotation @ [0.0, 1.0, 0.0]
    np.testing.assert_allclose(left, [0.0, cos, sin], atol=1e-12)  # left side up


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


def test_overlap_is_all_of_an_empty_room_and_nothing_of_what_is_hidden():
    assert overlap(in_a_box(HERE), in_a_box(THERE)) > 0.99
    assert overlap(in_a_box(HERE), in_a_box(THERE, hidden=True)) == 0.0
    half = in_a_box(THERE)
    half.ranges_m[:, : half.ranges_m.shape[1] // 2] = np.inf
    assert 0.2 < overlap(in_a_box(HERE), half) < 0.8


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


def test_of_two_keypoints_beside_one_another_the_nearer_gets_the_partner():
    here, there = in_a_box(HERE), in_a_box(THERE)
    first = np.array([[0.105, 0.1], [0.1, 0.1]])
    expected, _ = projected(first, here, there)
    truth = correspondences(first, expected[1:], here, there)
    assert truth.recurring.tolist() == [True, True]
    assert truth.pairs.tolist() == [[1, 0]]


@pytest.mark.parametrize("count", [0, 3])
def test_no_keypoints_are_no_error(count):
    truth = correspondences(np.zeros((count, 2)), np.zeros((0, 2)), in_a_box(HERE), in_a_box(THERE))
    assert truth.pairs.shape == (0, 2)
    assert not truth.recurring.any()
