"""A base that steers as a car does: arcs ahead or backwards, and moves to and fro where no arc leads there.

The camera and the distance sensors see all round, so backwards is as good as ahead: the course is followed in
the gear that faces it, and at most a right angle is ever turned. By pure pursuit the arc through a point at
distance d, off by angle a, bends by 2 sin(a) / d (R. C. Coulter, Implementation of the Pure Pursuit Path
Tracking Algorithm, CMU-RI-TR-92-01). A point inside the tightest circles is reached by none: then, or where
something stands on the arc, the robot turns where it is, to and fro at full lock, each move as long as it is
free, until it faces its course.
"""

import math
from dataclasses import replace

from services.drive.bases.course import BaseLimits, Course, Manoeuvre, Twist

LOOK_M = 0.6
"""Point of the course that is pursued where what is headed for is further; chosen: a body's length and a
half, less than the free way that a direction must have."""

GEAR_RAD = math.radians(110.0)
"""Off course by more the other gear is taken; chosen: 20 degrees beyond the middle, so that it does not
change to and fro."""

MOVE_M = 0.06
"""A move of less free way is not begun, and ends; chosen: what a robot that crawls goes in a second."""

FACED_RAD = math.radians(20.0)
"""Turning round ends once the course is faced to within this; chosen: from there an arc leads on."""

INSIDE = 0.9
"""Share of the tightest circle's chord within which a point counts as out of reach of an arc; chosen: so that
rounding does not begin a manoeuvre."""


def towards(course: Course, limits: BaseLimits, memory: Manoeuvre) -> tuple[Twist, Manoeuvre]:
    """The velocity that follows a course, and what to remember."""
    if course.speed_mps <= 0.0:
        return Twist(), memory
    if memory.turn:
        return _turn_round(course, limits, memory)
    gear = memory.gear if abs(_off_rad(course, memory.gear)) <= GEAR_RAD else -memory.gear
    off_rad = _off_rad(course, gear)
    tightest = 1.0 / limits.radius_m
    wanted = 2.0 * math.sin(min(abs(off_rad), 0.5 * math.pi)) / min(LOOK_M, course.distance_m)
    bend = math.copysign(min(wanted, tightest), gear * off_rad)
    chord_m = 2.0 * limits.radius_m * abs(math.sin(off_rad))
    reachable = course.distance_m >= INSIDE * chord_m or abs(off_rad) < FACED_RAD
    if reachable and _free_m(course, gear, bend) >= MOVE_M:
        return _move(course, gear, bend), Manoeuvre(gear)
    first = gear if reachable else -gear
    return _turn_round(course, limits, Manoeuvre(first, 1 if off_rad >= 0.0 else -1))


def _turn_round(course: Course, limits: BaseLimits, memory: Manoeuvre) -> tuple[Twist, Manoeuvre]:
    """One move of turning to and fro towards the course."""
    tightest = 1.0 / limits.radius_m
    faced = min((1, -1), key=lambda gear: abs(_off_rad(course, gear)))
    off_rad = _off_rad(course, faced)
    straight = _free_m(course, faced, 0.0) >= MOVE_M
    if abs(off_rad) < FACED_RAD and straight:
        return towards(course, limits, Manoeuvre(faced))
    turn = memory.turn if abs(off_rad) > FACED_RAD else (1 if off_rad >= 0.0 else -1)
    for gear in (memory.gear, -memory.gear):
        bend = gear * turn * tightest
        if _free_m(course, gear, bend) >= MOVE_M:
            return _move(course, gear, bend), Manoeuvre(gear, turn)
    # Wedged: out by whichever arc is longest.
    arcs = [(gear, bend * tightest) for gear in (1, -1) for bend in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    gear, bend = max(arcs, key=lambda arc: _free_m(course, *arc))
    return _move(course, gear, bend), replace(memory, turn=turn)


def _move(course: Course, gear: int, bend_per_m: float) -> Twist:
    forward_mps = gear * course.slowed(bend_per_m, backwards=gear < 0)
    return Twist(forward_mps, 0.0, forward_mps * bend_per_m)


def _free_m(course: Course, gear: int, bend_per_m: float) -> float:
    return course.obstacles.arc_clearance_m(bend_per_m, course.body_m, backwards=gear < 0)


def _off_rad(course: Course, gear: int) -> float:
    """How far the course is off, counter-clockwise, from where the robot goes in a gear."""
    return math.remainder(course.heading_rad - (0.0 if gear > 0 else math.pi), math.tau)
