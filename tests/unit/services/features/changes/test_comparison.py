"""What changed in a room of noise and pillars: found in any light, and nothing where only the robot moved."""

import math

import numpy as np
import pytest

from services.features.changes.comparison import Sensitivity, changed_regions, differences
from tests.unit.services.features import room

HEIGHT_PX = 256
PILLAR = room.PILLARS_M[-1]
BESIDE = (0.04, -0.05)
"""Of the second spot, metres: what a robot misses a place by at the median."""


def seen(at=(0.0, 0.0), yaw_rad=0.0, pillars=room.PILLARS_M):
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(room, "PILLARS_M", pillars)
        return room.render_room(*at, yaw_rad, HEIGHT_PX)


def dimmed(picture, gain=(0.3, 0.5, 0.7), noise=2.0):
    rough = np.random.default_rng(1).standard_normal(picture.shape)
    return np.clip(picture * np.array(gain) + noise * rough, 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def reference():
    return seen()


@pytest.fixture(scope="module")
def without():
    """From beside the first spot, turned, with one pillar gone."""
    return seen(BESIDE, 2.0, room.PILLARS_M[:-1])


def is_at_pillar(region, yaw_rad=0.0, at=BESIDE, pillar=PILLAR):
    bearing_rad = math.atan2(pillar[1] - at[1], pillar[0] - at[0]) - yaw_rad
    return abs(math.remainder(region.bearing_rad - bearing_rad, math.tau)) < math.radians(10.0)


@pytest.mark.parametrize("light", [lambda picture: picture, dimmed], ids=["same light", "half the light"])
def test_a_pillar_taken_away_is_reported_where_it_stood(reference, without, light):
    found = changed_regions(reference, light(without), 2.0, 0.02)
    assert found
    assert all(is_at_pillar(each, 2.0) for each in found)
    assert abs(found[0].elevation_rad) < math.radians(20.0)


def test_a_pillar_brought_is_reported_in_the_frame_of_the_camera_now(reference, without):
    found = changed_regions(without, reference, -2.0, 0.02)
    assert found
    assert all(is_at_pillar(each, at=(0.0, 0.0)) for each in found)
    assert all(each.width_rad < math.radians(45.0) for each in found)


@pytest.mark.parametrize("yaw_rad", [0.0, 2.0, -3.1], ids=lambda yaw: f"turned by {yaw:g}")
@pytest.mark.parametrize("light", [lambda picture: picture, dimmed], ids=["same light", "half the light"])
def test_nothing_is_reported_where_only_the_robot_stands_elsewhere(reference, yaw_rad, light):
    assert changed_regions(reference, light(seen(BESIDE, yaw_rad)), yaw_rad, 0.02) == []


def test_what_a_tenth_of_a_metre_uncovers_is_no_change(reference):
    assert changed_regions(reference, seen((0.1, 0.0), 1.0), 1.0, 0.04) == []


def test_a_wrong_turn_makes_everything_differ(reference):
    found = changed_regions(reference, seen(BESIDE, 2.0), 0.5, 0.02)
    assert sum(each.width_rad for each in found) > math.pi


def test_regions_across_the_seam_are_not_as_wide_as_the_picture(reference):
    yaw_rad = math.atan2(PILLAR[1], PILLAR[0]) - math.pi
    found = changed_regions(reference, seen((0.0, 0.0), yaw_rad, room.PILLARS_M[:-1]), yaw_rad)
    assert found
    assert all(math.pi - abs(each.bearing_rad) < math.radians(10.0) for each in found)
    assert all(each.width_rad < math.radians(45.0) for each in found)


def test_the_most_significant_comes_first_and_a_higher_bar_leaves_fewer(reference):
    now = seen((0.0, 0.0), 0.0, room.PILLARS_M[:-2])
    found = changed_regions(reference, now, 0.0)
    assert [each.score for each in found] == sorted((each.score for each in found), reverse=True)
    assert {is_at_pillar(each, at=(0.0, 0.0)) for each in found[:2]} == {True, False}
    assert changed_regions(reference, now, 0.0, sensitivity=Sensitivity(share=0.99)) == []


def test_pictures_of_two_sizes_are_compared(reference):
    assert changed_regions(reference, room.render_room(*BESIDE, 0.0, 2 * HEIGHT_PX), 0.0, 0.02) == []


def test_the_map_covers_45_degrees_to_either_side_of_the_horizon(reference):
    found = differences(reference, reference, 0.0, 0.0)
    assert found.map(1.0).shape == (96, 384)
    assert found.first_row == 48
    assert found.map(1.0).max() < 1e-3
