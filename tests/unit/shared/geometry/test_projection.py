"""Projection of fixed points, steps without dynamics, and a path that follows headings."""

import numpy as np
import pytest

from shared.geometry.projection import lonlat_from_points, step_position
from shared.geometry.two_view import two_view


@pytest.mark.parametrize(
    ("point", "yaw_deg", "lonlat_deg"),
    [
        ((2.0, 1.0, 1.0), 0.0, (0.0, 0.0)),
        ((1.0, 3.0, 1.0), 0.0, (90.0, 0.0)),
        ((1.0, 3.0, 1.0), 90.0, (0.0, 0.0)),
        ((2.0, 1.0, 2.0), 0.0, (0.0, 45.0)),
        ((0.0, 1.0, 0.0), 90.0, (90.0, -45.0)),
    ],
)
def test_direction_of_known_point_from_one_one_one(point, yaw_deg, lonlat_deg):
    seen = lonlat_from_points([point], [1.0, 1.0, 1.0], np.deg2rad(yaw_deg))
    np.testing.assert_allclose(np.rad2deg(seen), [lonlat_deg], atol=1e-9)


def test_step_is_speed_times_time_along_the_course():
    moved = step_position([1.0, 2.0, 0.5], np.deg2rad(60.0), np.deg2rad(30.0), 0.4, 0.5)
    np.testing.assert_allclose(moved, [1.0, 2.2, 0.5], atol=1e-12)


def test_point_in_the_camera_is_refused():
    with pytest.raises(ValueError, match="points_m must differ"):
        lonlat_from_points([[1.0, 1.0, 1.0]], [1.0, 1.0, 1.0])


def test_following_the_two_view_heading_step_by_step_reaches_the_goal():
    rng = np.random.default_rng(6)
    points = rng.uniform([-4, -4, -1], [4, 4, 1.6], (80, 3))
    points = points[np.hypot(points[:, 0], points[:, 1]) > 2.0]
    goal, position, yaw = np.array([1.0, 0.6, 0.0]), np.array([-0.9, -0.5, 0.0]), 0.4
    target = lonlat_from_points(points, goal, -2.0)
    for _ in range(60):
        result = two_view(lonlat_from_points(points, position, yaw), target, rng)
        if not result.usable:
            break
        position = step_position(position, result.heading_rad, yaw, 0.5, 0.1)
        yaw += 0.05
    assert np.linalg.norm(position - goal) < 0.06
