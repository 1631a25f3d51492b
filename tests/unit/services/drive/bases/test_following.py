"""A base that cannot go sideways gets to where it is headed, by what it can do."""

import math

import numpy as np
import pytest

from services.drive.bases.course import BaseLimits, Course, Manoeuvre
from services.drive.core import follow
from services.drive.limits import DriveLimits
from shared.geometry.clearance import Obstacles
from shared.motion.motion import NO_MOTION, driven

FREE = Obstacles(np.zeros((0, 2)))
STEP_S = 0.3


def drive(base, at_m, steps=80):
    """Twists given and the nearest the robot came to a point, in metres."""
    limits, here, memory = DriveLimits(base=BaseLimits(name=base)), NO_MOTION, Manoeuvre()
    twists, nearest_m = [], math.inf
    for _ in range(steps):
        away_m = math.dist((here.x_m, here.y_m), at_m)
        nearest_m = min(nearest_m, away_m)
        bearing_rad = math.atan2(at_m[1] - here.y_m, at_m[0] - here.x_m) - here.turn_rad
        course = Course(math.remainder(bearing_rad, math.tau), min(0.3, away_m), FREE, 0.3, 1.25, away_m)
        twist, memory = follow(course, memory, limits)
        twists.append(twist)
        here = here.then(driven(*twist, STEP_S))
    return twists, nearest_m


@pytest.mark.parametrize(
    ("base", "within_m"), [("holonomic", 0.01), ("differential", 0.05), ("ackermann", 0.3)]
)
@pytest.mark.parametrize("bearing_deg", range(0, 360, 30))
def test_a_point_two_metres_away_is_reached_in_any_direction(base, within_m, bearing_deg):
    angle = math.radians(bearing_deg)
    twists, nearest_m = drive(base, (2.0 * math.cos(angle), 2.0 * math.sin(angle)))
    assert nearest_m < within_m
    assert base == "holonomic" or all(twist.left_mps == 0.0 for twist in twists)


@pytest.mark.parametrize("bearing_deg", range(0, 360, 45))
def test_a_car_never_turns_tighter_than_it_can(bearing_deg):
    angle = math.radians(bearing_deg)
    twists, _ = drive("ackermann", (0.5 * math.cos(angle), 0.5 * math.sin(angle)))
    radius_m = BaseLimits().radius_m
    assert all(abs(t.turn_radps) * radius_m <= abs(t.forward_mps) + 1e-9 for t in twists)
