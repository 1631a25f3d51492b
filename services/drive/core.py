"""Pure core of the drive service: heading and distances in, command out."""

from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat, PositiveInt, model_validator

from services.drive.passing import Passing, PassingLimits, Steering, obstacle_heading, steer_away, steer_past
from shared.geometry.clearance import Obstacles
from shared.messages.drive import Command, Heading
from shared.messages.sensors import Ranges

SLOWEST = 0.25
"""Share of the speed that is left however near an obstacle is; chosen, see decision 0005."""


class WheelLimits(BaseModel):
    """Wheel speeds at full speed; section 6.2 of the thesis has 5 and 3 rad/s indoors, 10 and 6 outdoors."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    max_radps: PositiveFloat = 10.0
    min_radps: PositiveFloat = 6.0

    @model_validator(mode="after")
    def _ordered(self) -> "WheelLimits":
        if self.min_radps > self.max_radps:
            raise ValueError(f"min_radps must be at most max_radps, got {self.min_radps} > {self.max_radps}")
        return self


class DriveLimits(BaseModel):
    """How this robot drives.

    Attributes:
        avoidance: "passing" remembers the side it passes; "momentary" is the thesis's rule.
        obstacle_range_m: distance at which the momentary rule reacts (decision 0012, Q19: 0.5 m indoors).
        full_speed_clearance_m: free way ahead that full speed needs, and half speed half of it; chosen: a
            little more than the look-ahead, within which the way ahead changes.
        command_ttl_ms: the robot stops so long after the last command; a new one comes with the distances,
            every 100 ms: this bears the loss of one (tests/unit/services/drive/test_core.py).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    avoidance: Literal["passing", "momentary"] = "passing"
    wheels: WheelLimits = WheelLimits()
    passing: PassingLimits = PassingLimits()
    obstacle_range_m: PositiveFloat = 0.5
    full_speed_clearance_m: PositiveFloat = 1.0
    command_ttl_ms: PositiveInt = 250


def compute_command(
    heading: Heading, ranges: Ranges, memory: Passing, rng: np.random.Generator, limits: DriveLimits
) -> tuple[Command, Passing]:
    """Obstacles first, then the estimate, then the velocity law (figure 4.8, equations 6.5 and 6.6).

    Args:
        heading: what the planner wants.
        ranges: what the distance sensors see.
        memory: of the obstacle that is being passed, result of the previous step.
        rng: draws the momentary rule's weight.
        limits: of this robot.
    """
    if heading.action == "hold":
        return stop_command(heading, "hold: " + heading.why[:100], limits), memory
    steering, memory = _steer(heading, ranges, memory, rng, limits)
    if steering.blocked:
        return stop_command(heading, steering.why, limits), memory
    speed = wheel_speed(heading.s_cv, heading.s_slow, heading.s_max, heading.speed_fraction, limits.wheels)
    if limits.avoidance == "passing":
        safe = limits.wheels.max_radps * steering.clearance_m / limits.full_speed_clearance_m
        speed = min(speed, max(SLOWEST * speed, safe))
    return _command(heading, steering.why, limits, steering.heading_rad, speed, steering.avoiding), memory


def stop_command(heading: Heading, why: str, limits: DriveLimits) -> Command:
    """Wheels still, in answer to `heading`."""
    return _command(heading, why, limits)


def _command(
    heading: Heading,
    why: str,
    limits: DriveLimits,
    steer_rad: float = 0.0,
    wheel_speed_radps: float = 0.0,
    avoiding: bool = False,
) -> Command:
    return Command(
        seq=heading.seq,
        stamp_ns=heading.stamp_ns,
        robot=heading.robot,
        epoch=heading.epoch,
        ttl_ms=limits.command_ttl_ms,
        steer_rad=steer_rad,
        wheel_speed_radps=wheel_speed_radps,
        avoiding=avoiding,
        why=why,
    )


def wheel_speed(s_cv: int, s_slow: int, s_max: int, speed_fraction: float, limits: WheelLimits) -> float:
    """Wheel speed in rad/s, equation 6.6, then limited by the planner's `speed_fraction`."""
    speed_radps = max(limits.min_radps, velocity_gain(s_cv, s_slow, s_max) * limits.max_radps)
    return speed_radps * speed_fraction


def velocity_gain(s_cv: int, s_slow: int, s_max: int) -> float:
    """Gain K_v of equation 6.5, simplified (decision 0012, Q11): 1 - (S - S_slow) / S_max above S_slow.

    With the thesis's S_slow = 90 and S_max = 150: K(90) = 1, K(110) = 0.867, K(150) = 0.6.
    """
    if s_cv <= s_slow:
        return 1.0
    return max(0.0, 1.0 - (s_cv - s_slow) / s_max)


def _steer(
    heading: Heading, ranges: Ranges, memory: Passing, rng: np.random.Generator, limits: DriveLimits
) -> tuple[Steering, Passing]:
    if limits.avoidance == "momentary":
        near_rad = obstacle_heading(ranges.angles_rad, ranges.distances_m, limits.obstacle_range_m)
        return steer_away(heading.heading_rad, near_rad, rng), memory
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    return steer_past(heading.heading_rad, obstacles, memory, heading.speed_fraction, limits.passing)
