"""Leaning cameras as rotations: signs, order, and where an IMU finds down."""

import math

import numpy as np
import pytest

from simulator.sensors.attitude import LEVEL, UPRIGHT, composed, gravity_in, leaning, measured

A = math.radians(10.0)
DOWN = (0.0, 0.0, -1.0)


def matrix(lean):
    """Rotation matrix of a quaternion, by Rodrigues' formula."""
    w, *axis = lean
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def test_level_camera_has_gravity_straight_below():
    assert leaning(LEVEL) == UPRIGHT
    assert gravity_in(UPRIGHT) == DOWN


def test_nose_down_looks_below_the_horizon_and_left_up_raises_the_left():
    forward, left = np.eye(3)[0], np.eye(3)[1]
    assert matrix(leaning((A, 0.0))) @ forward == pytest.approx([math.cos(A), 0.0, -math.sin(A)])
    assert matrix(leaning((0.0, A))) @ left == pytest.approx([0.0, math.cos(A), math.sin(A)])
    assert gravity_in(leaning((A, 0.0))) == pytest.approx((math.sin(A), 0.0, -math.cos(A)))
    assert gravity_in(leaning((0.0, A))) == pytest.approx((0.0, -math.sin(A), -math.cos(A)))


def test_gravity_is_down_turned_back_into_the_camera():
    for lean in (leaning((0.1, -0.3)), composed(leaning((0.2, 0.1)), leaning((-0.4, 0.3)))):
        assert gravity_in(lean) == pytest.approx(matrix(lean).T @ DOWN)


def test_turns_are_multiplied_in_their_order_and_level_ones_change_no_bit():
    one, other = leaning((0.5, 0.0)), leaning((0.0, 0.7))
    assert matrix(composed(one, other)) == pytest.approx(matrix(one) @ matrix(other))
    assert matrix(composed(one, other)) != pytest.approx(matrix(composed(other, one)))
    assert composed(UPRIGHT, one, UPRIGHT) == one
    assert composed(UPRIGHT, UPRIGHT) == UPRIGHT


def test_reading_is_a_unit_vector_off_by_the_noise_about_each_axis():
    noise_rad, rng = math.radians(0.3), np.random.default_rng(1)
    readings = np.array([measured(DOWN, noise_rad, rng) for _ in range(4000)])
    assert np.linalg.norm(readings, axis=1) == pytest.approx(1.0)
    assert np.arcsin(readings[:, :2]).std(axis=0) == pytest.approx([noise_rad] * 2, rel=0.05)
    assert measured(DOWN, 0.0, rng) == DOWN
