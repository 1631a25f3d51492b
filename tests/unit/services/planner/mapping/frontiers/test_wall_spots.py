"""Readings of broad beams along a way tell where a wall is, and where a door in it, from metres away."""

import math

import numpy as np
import pytest

from services.planner.mapping.frontiers.wall_spots import RAY_RAD, wall_spots, walls_along_rays
from shared.messages.base import SECTORS

RADIUS_M, RANGE_M, NOISE_M = 0.27, 12.0, 0.01
DOOR = (-0.41, 0.41)
WITHIN_BEAM_RAD = np.deg2rad(np.arange(-15.0, 15.1, 0.5))


def along_wall(away_m, door=None, yaw_rad=0.0, way_m=2.4):
    """Views every 20 cm along a wall to the left, as broad beams with noise see it."""
    rng = np.random.default_rng(4)
    views = []
    for x_m in np.arange(-way_m / 2, way_m / 2 + 1e-6, 0.2):
        middles = yaw_rad + np.arange(SECTORS) * math.tau / SECTORS
        echoes = [
            min(echo_m(x_m, away_m, door, middle + off) for off in WITHIN_BEAM_RAD) for middle in middles
        ]
        read = [echo if echo == RANGE_M else echo + rng.normal(0.0, NOISE_M) for echo in echoes]
        views.append([x_m, 0.0, yaw_rad, *read])
    return np.array(views)


def echo_m(x_m, away_m, door, angle_rad):
    up = math.sin(angle_rad)
    if up <= 1e-6 or (door and door[0] < x_m + away_m / math.tan(angle_rad) < door[1]):
        return RANGE_M
    return min(RANGE_M, away_m / up)


def spots(views):
    found = wall_spots(views, RADIUS_M, RANGE_M)
    return found[np.argsort(found[:, 0])]


@pytest.mark.parametrize("yaw_rad", [0.0, 0.7])
@pytest.mark.parametrize("away_m", [0.8, 1.5, 2.5, 4.0])
def test_a_wall_is_located_without_a_gap_along_the_way(away_m, yaw_rad):
    found = spots(along_wall(away_m, yaw_rad=yaw_rad))
    assert np.abs(found[:, 1] - away_m).max() < RADIUS_M
    beside = found[np.abs(found[:, 0]) < 1.2, 0]
    assert np.diff(beside).max() < 2.0 * RADIUS_M


@pytest.mark.parametrize("away_m", [1.5, 2.5, 3.5])
def test_a_door_in_it_stays_a_gap(away_m):
    found = spots(along_wall(away_m, door=DOOR))
    in_door = (found[:, 0] > DOOR[0] + 0.05) & (found[:, 0] < DOOR[1] - 0.05)
    assert not in_door.any()
    assert (found[:, 0] < DOOR[0]).sum() > 5 < (found[:, 0] > DOOR[1]).sum()


def test_one_view_locates_only_what_is_too_near_to_pass_by():
    assert len(wall_spots(along_wall(2.5, way_m=0.0), RADIUS_M, RANGE_M)) == 0
    assert len(wall_spots(along_wall(0.8, way_m=0.0), RADIUS_M, RANGE_M)) > 0


def test_where_nothing_is_seen_there_is_no_wall():
    views = np.array([[0.2 * n, 0.0, 0.0, *[RANGE_M] * SECTORS] for n in range(9)])
    assert wall_spots(views, RADIUS_M, RANGE_M).shape == (0, 2)


def test_rays_end_at_the_nearest_spot_that_the_robot_cannot_pass():
    view = np.array([[1.0, 0.0, 2.0, *[RANGE_M] * SECTORS]])
    ahead = walls_along_rays(view, np.array([[3.0, 0.0], [6.0, 0.0]]), RADIUS_M)[0]
    assert ahead[0] == pytest.approx(2.0)
    beside = math.ceil(math.asin(RADIUS_M / 2.0) / RAY_RAD)
    assert np.isfinite(ahead).sum() == 2 * beside - 1
    assert ahead[beside - 1] == ahead[1 - beside] == pytest.approx(2.0)


def test_without_spots_no_ray_ends():
    assert np.isinf(walls_along_rays(along_wall(2.5), np.zeros((0, 2)), RADIUS_M)).all()
