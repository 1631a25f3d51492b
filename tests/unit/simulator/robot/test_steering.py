"""Leg control: which servo angle, when the wheel may turn."""

import math

import pytest

from simulator.robot.steering import LegTarget, choose_angle, next_targets
from simulator.robot.undercarriage import LEG_LIMIT_RAD, Mount, Roll
from simulator.settings import RobotSettings

ROBOT = RobotSettings()
REST = LegTarget(0.0, 0.0)
LEG = Mount(0.0, 0.0, 0.1, LEG_LIMIT_RAD)


def next_target(heading_rad, speed_mps, steer_rad, last):
    return next_targets([LEG], [Roll(heading_rad, speed_mps)], [steer_rad], [last], 0.01, ROBOT)[0]


@pytest.mark.parametrize(
    ("heading_deg", "now_deg", "angle_deg", "sign"),
    [
        (60, 0, 60, 1),
        (-30, 0, -30, 1),
        (180, 0, 0, -1),
        (-120, 0, 60, -1),
        (120, 80, -60, -1),
        (95, 0, -85, -1),
        (95, 60, 95, 1),
    ],
)
def test_nearest_reachable_servo_angle_is_chosen(heading_deg, now_deg, angle_deg, sign):
    angle, direction = choose_angle(math.radians(heading_deg), math.radians(now_deg), LEG_LIMIT_RAD)
    assert (round(math.degrees(angle)), direction) == (angle_deg, sign)


def test_servo_turns_no_faster_than_its_rate():
    target = next_target(1.5, 0.5, 0.0, REST)
    assert target.steer_rad == pytest.approx(ROBOT.steer_rate_radps * 0.01)


def test_wheel_waits_until_the_leg_points_the_right_way():
    assert next_target(1.5, 0.5, 0.0, REST).wheel_radps == 0.0
    assert next_target(1.5, 0.5, 1.5, LegTarget(1.5, 0.0)).wheel_radps > 0.0


def test_wheel_speed_is_limited():
    fast = LegTarget(0.0, ROBOT.wheel_limit_radps)
    assert next_target(0.0, 9.0, 0.0, fast).wheel_radps == ROBOT.wheel_limit_radps
