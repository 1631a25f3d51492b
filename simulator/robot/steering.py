"""Low-level control of one leg, as its servo controllers would do it. Pure.

A steer servo turns at a limited rate within +-limit. A wheel can run either way, so a heading is reached by
the nearer of two servo angles, half a turn apart. Wheel speed is scaled by the cosine of the steering error
and zero while that is large, so that wheels roll rather than scrub.
"""

import math
from dataclasses import dataclass

from simulator.settings import RobotSettings

MOST_ERROR_RAD = 0.35
"""Steering error, 20 degrees, beyond which a wheel stands; chosen."""


@dataclass(frozen=True)
class LegTarget:
    """What the servos of a leg are asked for."""

    steer_rad: float
    wheel_radps: float


def wrap_rad(angle: float) -> float:
    """Into [-pi, pi)."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def choose_angle(heading_rad: float, steer_rad: float, limit_rad: float) -> tuple[float, float]:
    """Servo angle for a heading and the wheel's direction (+1, -1): the reachable one nearest by."""
    options = [
        (wrap_rad(heading_rad) + turn, sign)
        for turn, sign in (
            (0.0, 1.0),
            (math.pi, -1.0),
            (-math.pi, -1.0),
            (2 * math.pi, 1.0),
            (-2 * math.pi, 1.0),
        )
        if abs(wrap_rad(heading_rad) + turn) <= limit_rad
    ]
    return min(options, key=lambda option: (abs(option[0] - steer_rad), -option[1]))


def next_target(
    heading_rad: float,
    wheel_radps: float,
    steer_rad: float,
    last: LegTarget,
    dt_s: float,
    robot: RobotSettings,
) -> LegTarget:
    """Targets for the next physics step.

    Args:
        heading_rad: wanted rolling direction, robot frame.
        wheel_radps: wanted wheel speed in that direction; negative rolls backwards.
        steer_rad: measured steer angle.
        last: targets of the step before.
        dt_s: length of a step.
        robot: limits.
    """
    wanted, sign = choose_angle(heading_rad, last.steer_rad, robot.steer_limit_rad)
    most = robot.steer_rate_radps * dt_s
    steer = last.steer_rad + max(-most, min(most, wanted - last.steer_rad))
    aligned = max(0.0, math.cos(wanted - steer_rad))
    if abs(wanted - steer_rad) > MOST_ERROR_RAD:
        aligned = 0.0  # the other legs may point elsewhere: wait
    speed = sign * max(-robot.wheel_limit_radps, min(robot.wheel_limit_radps, wheel_radps)) * aligned
    change = robot.wheel_accel_radps2 * dt_s
    return LegTarget(steer, last.wheel_radps + max(-change, min(change, speed - last.wheel_radps)))
