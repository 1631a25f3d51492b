"""Pure core of the drive service: heading and distances in, command out."""

from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat, PositiveInt

from services.drive.momentary import obstacle_heading, steer_away
from services.drive.passing import Passing, PassingLimits, steer_past
from services.drive.steering import Steering
from services.drive.velocity import WheelLimits, wheel_speed
from shared.geometry.clearance import Obstacles
from shared.messages import Command, Heading, Ranges

SLOWEST = 0.25
DECIDING_S = 2.0
"""The longest that features and planner may take from a frame to its heading."""


class DriveLimits(BaseModel):
    """How this robot drives.

    Attributes:
        avoidance: "passing" remembers the side it passes; "momentary" is the thesis's rule.
        obstacle_range_m: distance at which the momentary rule reacts.
        full_speed_clearance_m: free way ahead below which passing slows down in proportion.
        command_ttl_ms: the robot stops so long after the last command; a new one comes with the distances.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    avoidance: Literal["passing", "momentary"] = "passing"
    wheels: WheelLimits = WheelLimits()
    passing: PassingLimits = PassingLimits()
    obstacle_range_m: PositiveFloat = 0.5
    full_speed_clearance_m: PositiveFloat = 0.5
    command_ttl_ms: PositiveInt = 250


def compute_command(
    heading: Heading, ranges: Ranges, memory: Passing, rng: np.random.Generator, limits: DriveLimits
) -> tuple[Command, Passing]:
    """Obstacles first, then the estimate, then the velocity law (figure 4.8, equations 6.5 and 6.6)."""
    if heading.action == "hold":
        return stop_command(heading, "hold: " + heading.why[:100], limits), memory
    steering, memory = _steer(heading, ranges, memory, rng, limits)
    if steering.blocked:
        return stop_command(heading, steering.why, limits), memory
    speed = wheel_speed(heading.s_cv, heading.s_slow, heading.s_max, heading.speed_fraction, limits.wheels)
    if limits.avoidance == "passing":
        speed *= min(1.0, max(SLOWEST, steering.clearance_m / limits.full_speed_clearance_m))
    command = Command(
        seq=heading.seq,
        stamp_ns=heading.stamp_ns,
        robot=heading.robot,
        epoch=heading.epoch,
        ttl_ms=limits.command_ttl_ms,
        steer_rad=steering.heading_rad,
        wheel_speed_radps=speed,
        avoiding=steering.avoiding,
        why=steering.why,
    )
    return command, memory


def stop_command(heading: Heading, why: str, limits: DriveLimits) -> Command:
    """Wheels still, in answer to `heading`."""
    return Command(
        seq=heading.seq,
        stamp_ns=heading.stamp_ns,
        robot=heading.robot,
        epoch=heading.epoch,
        ttl_ms=limits.command_ttl_ms,
        why=why,
    )


def is_stale(heading: Heading, age_s: float) -> bool:
    """Whether a heading outlived its ttl on its way; `age_s` is that of its frame."""
    return age_s > DECIDING_S + heading.ttl_ms / 1000.0


def is_behind(message: Heading | Ranges, newest: Heading | Ranges) -> bool:
    """Whether a message is older than `newest`, by number and by time: a restarted robot counts anew."""
    return message.seq < newest.seq and message.stamp_ns < newest.stamp_ns


def is_overtaken(heading: Heading, last: Heading) -> bool:
    """Whether a planner's newer answer came before this one. One said twice does not live longer for that."""
    if heading.epoch != last.epoch:
        return False
    again = (heading.seq, heading.stamp_ns, heading.mission_id) == (last.seq, last.stamp_ns, last.mission_id)
    return again or is_behind(heading, last)


def _steer(
    heading: Heading, ranges: Ranges, memory: Passing, rng: np.random.Generator, limits: DriveLimits
) -> tuple[Steering, Passing]:
    if limits.avoidance == "momentary":
        near_rad = obstacle_heading(ranges.angles_rad, ranges.distances_m, limits.obstacle_range_m)
        return steer_away(heading.heading_rad, near_rad, rng), memory
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    return steer_past(heading.heading_rad, obstacles, memory, heading.speed_fraction, limits.passing)
