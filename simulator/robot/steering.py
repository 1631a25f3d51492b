"""Low-level control of one wheel, as its servo controllers would do it. Pure.

A steer servo turns at a limited rate within its limits. A wheel can run either way, so a heading is reached
by the nearer of two servo angles, half a turn apart. Wheel speed is scaled by the cosine of the steering
error and zero while that is large, so that wheels roll rather than scrub.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from simulator.robot.undercarriage import Mount, Roll
from simulator.settings import RobotSettings

MOST_ERROR_RAD = 0.35
"""Steering error, 20 degrees, beyond which a wheel stands; chosen."""


@dataclass(frozen=True)
class LegTarget:
    """What the servos of a wheel are asked for."""

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


def next_targets(
    mounts: Sequence[Mount],
    rolls: Sequence[Roll],
    steers_rad: Sequence[float],
    last: Sequence[LegTarget],
    dt_s: float,
    robot: RobotSettings,
) -> list[LegTarget]:
    """Targets for the next physics step, one for each wheel.

    Args:
        mounts: of the wheels.
        rolls: what each is to do.
        steers_rad: measured steer angles; 0 for wheels that do not steer.
        last: targets of the step before.
        dt_s: length of a step.
        robot: limits of the servos.
    """
    wanted = [_servo(mount, roll, target) for mount, roll, target in zip(mounts, rolls, last, strict=True)]
    errors_rad = [abs(angle - steer) for (angle, _), steer in zip(wanted, steers_rad, strict=True)]
    worst_rad = max(errors_rad)  # wheels wait for one another
    return [
        _target(mount, servo, worst_rad, target, dt_s, robot)
        for mount, servo, target in zip(mounts, wanted, last, strict=True)
    ]


def _servo(mount: Mount, roll: Roll, last: LegTarget) -> tuple[float, float]:
    """Servo angle and speed over the floor that one wheel wants; a wheel at rest keeps where it points."""
    if not mount.steered:
        return 0.0, roll.speed_mps
    if roll.speed_mps == 0.0:
        return last.steer_rad, 0.0
    if not mount.driven:
        return max(-mount.limit_rad, min(mount.limit_rad, roll.heading_rad)), roll.speed_mps
    angle, sign = choose_angle(roll.heading_rad, last.steer_rad, mount.limit_rad)
    return angle, sign * roll.speed_mps


def _target(
    mount: Mount,
    servo: tuple[float, float],
    error_rad: float,
    last: LegTarget,
    dt_s: float,
    robot: RobotSettings,
) -> LegTarget:
    wanted_rad, speed_mps = servo
    most = robot.steer_rate_radps * dt_s
    steer_rad = last.steer_rad + max(-most, min(most, wanted_rad - last.steer_rad))
    aligned = math.cos(error_rad) if error_rad <= MOST_ERROR_RAD else 0.0
    limit = robot.wheel_limit_radps
    wheel_radps = max(-limit, min(limit, speed_mps / mount.radius_m)) * aligned
    change = robot.wheel_accel_radps2 * dt_s
    return LegTarget(steer_rad, last.wheel_radps + max(-change, min(change, wheel_radps - last.wheel_radps)))
