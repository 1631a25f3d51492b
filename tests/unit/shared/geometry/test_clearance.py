"""Free way of a disc between echoes: hand-computed distances, beams, and narrow passages."""

import math

import numpy as np
import pytest

from shared.geometry.clearance import Obstacles

ANGLES = tuple(i * math.tau / 12 for i in range(12))


def test_disc_stops_where_it_touches():
    point = Obstacles(np.array([[1.0, 0.0], [1.0, 0.18]]))
    headings = np.array([0.0, math.pi, math.pi / 2])
    np.testing.assert_allclose(point.clearance_m(headings, 0.3), [0.7, np.inf, np.inf])


def test_offset_point_is_touched_later():
    point = Obstacles(np.array([[1.0, 0.18]]))
    assert point.clearance_m(np.array([0.0]), 0.3)[0] == pytest.approx(1.0 - 0.24)


def test_nothing_seen_is_free_for_ever():
    free = Obstacles.from_ranges(ANGLES, (4.0,) * 12, 4.0)
    assert np.isinf(free.clearance_m(np.array([0.3]), 0.3)).all()


def test_echo_is_spread_over_its_beam():
    distances = (1.0, *[4.0] * 11)
    echo = Obstacles.from_ranges(ANGLES, distances, 4.0)
    bearings = np.arctan2(echo.points_m[:, 1], echo.points_m[:, 0])
    assert np.ptp(bearings) == pytest.approx(math.radians(24.0))


def corridor(half_width_m):
    """What 30-degree beams read between two parallel walls."""
    rays = np.deg2rad(np.linspace(-15.0, 15.0, 31))
    angles = np.array(ANGLES)[:, None] + rays
    return tuple(np.clip(half_width_m / np.abs(np.sin(angles)).clip(1e-3), 0.0, 4.0).min(axis=1))


@pytest.mark.parametrize("half_width_m", [0.46, 0.6, 0.8])
def test_passage_wider_than_the_robot_stays_open(half_width_m):
    seen = Obstacles.from_ranges(ANGLES, corridor(half_width_m), 4.0)
    assert seen.clearance_m(np.array([0.0]), 0.31)[0] > 0.6


def test_passage_narrower_than_the_robot_is_closed():
    seen = Obstacles.from_ranges(ANGLES, corridor(0.25), 4.0)
    assert seen.clearance_m(np.array([0.0]), 0.31)[0] < 0.4
