"""A base of two wheels on one axle: it turns towards its course, and curves into it when it nearly faces it.

It turns on the spot, which a round body always can. The camera sees all round, so nothing is lost by facing
elsewhere; but only straight ahead does the way that was found free begin where the robot is, so it goes once
it faces the course to within ALIGNED_RAD, and no faster than the arc it then drives is free.
"""

import math

from services.drive.bases.course import BaseLimits, Course, Twist

TURN_S = 0.5
"""The course is faced in about this time: slower than a step in lockstep (0.3 s), so that it is not overshot,
also where the turn itself lags by a fifth of a second. Chosen."""

ALIGNED_RAD = math.radians(45.0)
"""Off course by more it only turns. Chosen: the arc that leads back from there, at half a metre a second,
stays within a body's radius of the course."""


def towards(course: Course, limits: BaseLimits) -> Twist:
    """The velocity that follows a course."""
    off_rad = course.heading_rad
    turn_radps = max(-limits.turn_radps, min(limits.turn_radps, off_rad / TURN_S))
    facing = (math.cos(off_rad) - math.cos(ALIGNED_RAD)) / (1.0 - math.cos(ALIGNED_RAD))
    if facing <= 0.0 or course.speed_mps <= 0.0:
        return Twist(turn_radps=turn_radps)
    forward_mps = facing * course.speed_mps
    return Twist(min(forward_mps, course.slowed(turn_radps / forward_mps)), 0.0, turn_radps)
