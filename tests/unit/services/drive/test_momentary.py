"""The thesis's avoidance: direction of the obstacle, and the blend that leaves it."""

import math

import numpy as np
import pytest

from services.drive.momentary import obstacle_heading, steer_away

ANGLES = tuple(math.remainder(i * math.tau / 12, math.tau) for i in range(12))


def distances(**near):
    readings = [4.0] * 12
    for sector, value in near.items():
        readings[int(sector[1:])] = value
    return tuple(readings)


def test_obstacle_heading_is_the_near_sensor():
    assert obstacle_heading(ANGLES, distances(s3=0.4), 0.5) == pytest.approx(math.pi / 2)


def test_two_near_sensors_give_the_direction_between():
    assert obstacle_heading(ANGLES, distances(s0=0.4, s1=0.4), 0.5) == pytest.approx(math.radians(15.0))


def test_nothing_near_is_no_obstacle():
    assert obstacle_heading(ANGLES, distances(), 0.5) is None
    assert steer_away(0.3, None, np.random.default_rng(0)).heading_rad == 0.3


def test_blend_leans_away_and_keeps_part_of_the_estimate():
    rng = np.random.default_rng(1)
    for _ in range(200):
        steering = steer_away(math.pi / 2, 0.0, rng)
        assert steering.avoiding
        assert math.pi / 2 < steering.heading_rad < math.pi, "between the estimate and straight away"
        assert steering.heading_rad > math.radians(135.0) - 1e-9, "w1 is above one half"
