"""Angles on the circle: wrapping, shortest differences, means."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shared.geometry.angles import circular_mean_rad, difference_rad, wrap_rad

ANGLES = st.floats(-1e3, 1e3)


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [(0.0, 0.0), (np.pi, -np.pi), (-np.pi, -np.pi), (1.5 * np.pi, -0.5 * np.pi), (-1.5 * np.pi, 0.5 * np.pi)],
)
def test_wrap_of_known_angles(angle, wrapped):
    assert wrap_rad(angle) == pytest.approx(wrapped, abs=1e-12)


@settings(deadline=None)
@given(ANGLES)
def test_wrapped_angle_is_half_open_and_points_the_same_way(angle):
    wrapped = float(wrap_rad(angle))
    assert -np.pi <= wrapped < np.pi
    assert np.cos(wrapped) == pytest.approx(np.cos(angle), abs=1e-9)
    assert np.sin(wrapped) == pytest.approx(np.sin(angle), abs=1e-9)


def test_just_below_minus_pi_does_not_become_plus_pi():
    assert float(wrap_rad(np.nextafter(-np.pi, -10.0))) < np.pi
    assert float(wrap_rad(-np.pi - 1e-17)) == -np.pi


def test_difference_takes_the_short_way_across_the_seam():
    assert difference_rad(np.deg2rad(-170.0), np.deg2rad(170.0)) == pytest.approx(np.deg2rad(20.0))
    assert difference_rad(np.deg2rad(170.0), np.deg2rad(-170.0)) == pytest.approx(np.deg2rad(-20.0))


def test_mean_across_the_seam_lies_on_the_seam():
    assert abs(circular_mean_rad(np.deg2rad([170.0, -170.0]))) == pytest.approx(np.pi)


def test_weights_pull_the_mean():
    assert circular_mean_rad([0.0, np.pi / 2.0], [1.0, 0.0]) == pytest.approx(0.0)
    assert circular_mean_rad([0.0, np.pi / 2.0], [1.0, 1.0]) == pytest.approx(np.pi / 4.0)


@pytest.mark.parametrize("angles", [[], [0.0, np.pi]])
def test_mean_without_a_direction_is_refused(angles):
    with pytest.raises(ValueError, match="angles_rad"):
        circular_mean_rad(angles)
