"""Pure core of the drive service: heading, distances and what the robot did since in, velocity out."""

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from services.drive.bases import ackermann, differential
from services.drive.bases.course import Course, Manoeuvre, Twist
from services.drive.limits import DriveLimits, SpeedLimits
from services.drive.passing import Passing, Steering, Wish, obstacle_heading, steer_away, steer_past
from shared.geometry.clearance import Obstacles
from shared.messages.drive import Heading, Velocity
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION, Motion

SLOWEST = 0.25
"""Share of the speed that is left however near an obstacle is; chosen, see decision 0005."""
FACING_S, FACED_RAD = 0.5, math.radians(1.0)
"""Time constant of a turn on the spot, and what is left of it at its end; chosen: five frames, and less than
any keypoint tells."""
NEARLY_THERE = 0.5
"""Share of its distance within which the bearing of what is headed for is no longer corrected by the way made
since it was seen: distances are told to a factor of 1.5 (decision 0037)."""


class Aim(NamedTuple):
    """Where the robot is going: bearing in its frame, and how far; inf where that is not known."""

    bearing_rad: float
    distance_m: float


@dataclass(frozen=True)
class Since:
    """What the robot did, by odometry or commands.

    Attributes:
        step: since the velocity before.
        frame: since the frame was taken that the heading was decided from.
        delay_s: how long ago that was.
    """

    step: Motion = NO_MOTION
    frame: Motion = NO_MOTION
    delay_s: float = 0.0


@dataclass(frozen=True)
class Memory:
    """Of the obstacle that is being passed and of the manoeuvre under way; a handful of numbers."""

    passing: Passing = field(default_factory=Passing)
    manoeuvre: Manoeuvre = field(default_factory=Manoeuvre)


def compute_velocity(
    heading: Heading,
    ranges: Ranges,
    since: Since,
    memory: Memory,
    rng: np.random.Generator,
    limits: DriveLimits,
) -> tuple[Velocity, Memory]:
    """Obstacles first, then the estimate, then the velocity law (figure 4.8, equations 6.5 and 6.6).

    Args:
        heading: what the planner wants.
        ranges: what the distance sensors see.
        since: how the robot moved meanwhile.
        memory: result of the previous step.
        rng: draws the momentary rule's weight.
        limits: of this robot.
    """
    memory = replace(memory, passing=memory.passing.turned(since.step))
    if heading.action == "hold" and heading.face_rad is not None and limits.base.name != "ackermann":
        return _facing(heading, heading.face_rad, since, limits), memory
    if heading.action == "hold":
        return stop_velocity(heading, "hold: " + heading.why[:100], limits), memory
    aim = now_at(heading, since.frame)
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    steering, passing = _steer(aim, heading, ranges, obstacles, memory.passing, rng, limits)
    memory = replace(memory, passing=passing)
    if steering.blocked:
        return stop_velocity(heading, steering.why, limits), memory
    contact_s = limits.contact_s + since.delay_s
    fraction = min(heading.speed_fraction, steering.speed_fraction)
    speed_mps = speed(heading.s_cv, heading.s_slow, heading.s_max, fraction, limits.speeds)
    if limits.avoidance == "passing":
        safe_mps = steering.clearance_m / contact_s
        speed_mps = min(speed_mps, max(SLOWEST * speed_mps, safe_mps))
    course = Course(
        steering.heading_rad,
        speed_mps,
        obstacles,
        limits.passing.disc_m(fraction),
        contact_s,
        math.inf if steering.avoiding else aim.distance_m,
    )
    twist, manoeuvre = follow(course, memory.manoeuvre, limits)
    velocity = stop_velocity(heading, steering.why, limits).model_copy(
        update={**twist._asdict(), "avoiding": steering.avoiding}
    )
    return velocity, replace(memory, manoeuvre=manoeuvre)


def _facing(heading: Heading, face_rad: float, since: Since, limits: DriveLimits) -> Velocity:
    """Turning on the spot, slower as the front comes to where it is to look."""
    left_rad = math.remainder(face_rad - since.frame.turn_rad, math.tau)
    most_radps = limits.base.turn_radps
    turn_radps = max(-most_radps, min(most_radps, left_rad / FACING_S))
    standing = stop_velocity(heading, heading.why[:100], limits)
    return standing if abs(left_rad) < FACED_RAD else standing.model_copy(update={"turn_radps": turn_radps})


def follow(course: Course, memory: Manoeuvre, limits: DriveLimits) -> tuple[Twist, Manoeuvre]:
    """The velocity by which this base follows a course."""
    if limits.base.name == "differential":
        return differential.towards(course, limits.base), memory
    if limits.base.name == "ackermann":
        return ackermann.towards(course, limits.base, memory)
    x, y = math.cos(course.heading_rad), math.sin(course.heading_rad)
    return Twist(course.speed_mps * x, course.speed_mps * y), memory


def stop_velocity(heading: Heading, why: str, limits: DriveLimits) -> Velocity:
    """Standing still, in answer to `heading`."""
    return Velocity(
        seq=heading.seq,
        stamp_ns=heading.stamp_ns,
        robot=heading.robot,
        epoch=heading.epoch,
        ttl_ms=limits.command_ttl_ms,
        why=why,
    )


def now_at(heading: Heading, moved: Motion) -> Aim:
    """Bearing and distance of what is headed for, after the robot moved since it was seen; inf: not known."""
    distance_m = heading.distance_m
    if distance_m is None:
        return Aim(moved.direction(heading.heading_rad), math.inf)
    left_m = max(0.0, distance_m - moved.way_m)
    if moved.way_m > NEARLY_THERE * distance_m:
        return Aim(moved.direction(heading.heading_rad), left_m)
    return Aim(moved.direction(heading.heading_rad, distance_m), left_m)


def speed(s_cv: int, s_slow: int, s_max: int, speed_fraction: float, limits: SpeedLimits) -> float:
    """Speed in m/s, equation 6.6, then limited by the planner's `speed_fraction`."""
    return max(limits.min_mps, velocity_gain(s_cv, s_slow, s_max) * limits.max_mps) * speed_fraction


def velocity_gain(s_cv: int, s_slow: int, s_max: int) -> float:
    """Gain K_v of equation 6.5, simplified (decision 0012, Q11): 1 - (S - S_slow) / S_max above S_slow.

    With the thesis's S_slow = 90 and S_max = 150: K(90) = 1, K(110) = 0.867, K(150) = 0.6.
    """
    if s_cv <= s_slow:
        return 1.0
    return max(0.0, 1.0 - (s_cv - s_slow) / s_max)


def _steer(
    aim: Aim,
    heading: Heading,
    ranges: Ranges,
    obstacles: Obstacles,
    memory: Passing,
    rng: np.random.Generator,
    limits: DriveLimits,
) -> tuple[Steering, Passing]:
    if limits.avoidance == "momentary":
        near_rad = obstacle_heading(ranges.angles_rad, ranges.distances_m, limits.obstacle_range_m)
        return steer_away(aim.bearing_rad, near_rad, rng), memory
    wish = Wish(aim.bearing_rad, heading.speed_fraction, aim.distance_m)
    return steer_past(wish, obstacles, memory, limits.passing)
