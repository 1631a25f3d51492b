"""Getting round obstacles: what follows a border with a memory, and the thesis's rule without one. Pure.

To pass is to follow the border of an obstacle until the way ahead is free and all turning is undone. The rule
is Pledge's (Abelson and diSessa, Turtle Geometry, 1981) with a compass that is the planner's heading: the
deflection from the wished heading is counted, also beyond half a turn, and the border is left only when it
has come back to zero. A side that does not lead past in time is given up for the other, with twice the
patience each time: without a map of the obstacle no search wastes less. What leads far aside at the speed
asked for is tried slowly first, to either side: to a slow robot narrower gaps are open. This memory ages in
steps.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat, PositiveInt

from shared.geometry.clearance import FloatArray, Obstacles
from shared.motion.motion import Motion

STEP_RAD = math.radians(10.0)
"""Directions that are tried; chosen: finer than half the beam of a sensor (clearance.HALF_BEAM_RAD)."""
BACKTRACK_RAD = math.radians(100.0)
"""Turning that one step may undo; chosen: a border that goes round a right angle, and one direction more."""
PREFERENCE_RAD = math.radians(50.0)
"""So much easier must the other side be to be taken; chosen: five of the directions that are tried."""
JUMP_RAD = math.radians(60.0)
"""A wish that changes this much between two steps is for another destination (chosen, decision 0005)."""
ONWARD_RAD = math.radians(100.0)
"""Deflection up to which the robot still goes on or aside; chosen: beyond a right angle it goes back."""
SQUEEZE_SHARE = 0.5
"""Share of the look-ahead that is enough for going on or aside, where only the way back has all of it: a gap
of 0.82 m beside an open leaf begins a step aside; chosen: two steps."""
ASIDE_RAD = math.radians(70.0)
"""Deflection beyond which a border is followed slowly; chosen: less than straight along a wall ahead."""
SLOWLY = 0.2
"""Share of full speed at which such a border is followed: to a slow robot gaps are open that its twelve
distances show as shut at speed. Of 40 starts before gaps of 0.66 to 0.82 m, beside a leaf that stands across
a corridor and in the middle of a wall, 4 lead through at full speed alone, and 39 so; at half of it 29 and
38 (tests/unit/services/drive/test_passing.py)."""
SLOW_TRIES = 2
"""Of the tries on one border so many are slow, one to either side: no long search for a gap in a wall."""
LAST_M = 0.03
"""Free way that a direction needs at the very spot; chosen: two of the slowest steps."""
BESIDE_M = 0.5
"""Between two spots that are nearer to each other and where a robot fits stands nothing: twice its radius."""
FULL_TURN_RAD = 2.0 * math.pi
SPOT_M_PER_RAD = 0.1
"""A robot that goes less than this for each radian that it turns, turns on the spot; chosen: a quarter of the
tightest circle that it curves on."""


class Wish(NamedTuple):
    """Where the planner wants to go.

    Attributes:
        heading_rad: robot frame.
        speed_fraction: the share of full speed at most; a slow robot near its goal looks less far ahead.
        distance_m: how far it is; inf where that is not known.
    """

    heading_rad: float
    speed_fraction: float = 1.0
    distance_m: float = math.inf


class PassingLimits(BaseModel):
    """Sizes of the robot and patience of the rule; chosen so that it drives through its own doors untouched.

    Attributes:
        radius_m, radius_slow_m: of the disc that must fit, at full speed and near standstill: the body's
            radius of 0.25 m (simulator/settings.py), with 5.5 and 2.5 cm to spare; 4 cm at half speed.
        lookahead_m, lookahead_min_m: free way that a direction needs, likewise.
        memory_steps: the side is remembered so long after a border was left.
        patience_steps, patience_growth: a side is given up after so many steps, then so many times as many
            (decision 0005).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    radius_m: PositiveFloat = 0.305
    radius_slow_m: PositiveFloat = 0.275
    lookahead_m: PositiveFloat = 0.78
    lookahead_min_m: PositiveFloat = 0.12
    memory_steps: PositiveInt = 15
    patience_steps: PositiveInt = 14
    patience_growth: PositiveFloat = 2.0

    def disc_m(self, speed_fraction: float) -> float:
        """Radius of the disc that must fit at a share of full speed."""
        return self.radius_slow_m + (self.radius_m - self.radius_slow_m) * speed_fraction

    def needed_m(self, wish: Wish) -> float:
        """Free way that a direction needs: less for a slow robot, and close to where it is going."""
        ahead_m = self.lookahead_min_m + (self.lookahead_m - self.lookahead_min_m) * wish.speed_fraction
        return min(ahead_m, max(wish.distance_m, LAST_M))


class Steering(NamedTuple):
    """Direction to drive in (robot frame) and why.

    Attributes:
        clearance_m: free way in that direction; limits the speed.
        blocked: no direction is free; stand still.
        speed_fraction: share of full speed at which that way is free.
    """

    heading_rad: float
    avoiding: bool
    why: str
    clearance_m: float = float("inf")
    blocked: bool = False
    speed_fraction: float = 1.0


@dataclass(frozen=True)
class Passing:
    """Memory between steps.

    Attributes:
        side: +1 passes obstacles with turns to the left, -1 to the right, 0 undecided.
        deflection_rad: turning away from the wished heading so far, towards `side`, never negative.
        steps: steps on this border; idle_steps: steps since it was left.
        wished_rad: the wish of the previous step.
        tries: earlier ones on this border, at the speed asked for and to either side; each doubles the
            patience.
    """

    side: int = 0
    deflection_rad: float = 0.0
    steps: int = 0
    idle_steps: int = 0
    tries: int = 0
    wished_rad: float | None = None

    def towards(self, wished_rad: float, distance_m: float) -> "Passing":
        """The memory for a new wish: the border is kept while the wish drifts, forgotten when it jumps.

        Beside where the robot is going to nothing stands between: a border that leads back from it is left.
        """
        if self.wished_rad is None:
            return replace(self, wished_rad=wished_rad)
        change_rad = _wrap(wished_rad - self.wished_rad)
        turned_rad = max(0.0, self.deflection_rad - self.side * change_rad) if self.deflection_rad else 0.0
        if abs(change_rad) > JUMP_RAD or (distance_m < BESIDE_M and turned_rad > ONWARD_RAD):
            return Passing(wished_rad=wished_rad)
        return replace(self, deflection_rad=turned_rad, wished_rad=wished_rad)

    def turned(self, step: Motion) -> "Passing":
        """The memory after the robot moved: directions are kept in its frame.

        A robot that turned on the spot is no step further along the border.
        """
        if self.wished_rad is None or step.turn_rad == 0.0:
            return self
        on_the_spot = step.way_m < SPOT_M_PER_RAD * abs(step.turn_rad)
        steps = max(0, self.steps - 1) if on_the_spot and self.deflection_rad else self.steps
        return replace(self, wished_rad=_wrap(self.wished_rad - step.turn_rad), steps=steps)

    def rested(self, limits: PassingLimits) -> "Passing":
        """The memory after a step without an obstacle: it fades, and is gone after a while."""
        idle = self.idle_steps + 1
        if idle >= limits.memory_steps:
            return Passing(wished_rad=self.wished_rad)
        return replace(self, steps=max(0, self.steps - 1), idle_steps=idle)


def steer_past(
    wish: Wish, obstacles: Obstacles, memory: Passing, limits: PassingLimits
) -> tuple[Steering, Passing]:
    """Choose the direction nearest to the wished one that keeps the border on the chosen side.

    Args:
        wish: where the planner wants to go.
        obstacles: what the distance sensors see.
        memory: result of the previous step.
        limits: sizes and patience.
    """
    memory = memory.towards(wish.heading_rad, wish.distance_m)
    straight = _straight_on(wish, obstacles, memory, limits)
    if straight is not None:
        return straight, memory.rested(limits)
    if not memory.tries:
        steering, after = _follow_border(wish, obstacles, memory, limits)
        if not steering.blocked and after.deflection_rad <= ASIDE_RAD:
            return steering, after
        memory = replace(memory, tries=1)
    if memory.tries <= SLOW_TRIES:
        wish = wish._replace(speed_fraction=min(SLOWLY, wish.speed_fraction))
    return _follow_border(wish, obstacles, memory, limits)


def _straight_on(wish: Wish, obstacles: Obstacles, memory: Passing, limits: PassingLimits) -> Steering | None:
    """The wished direction, where no border is followed and nothing is in the way at this share of speed."""
    if memory.deflection_rad:
        return None
    ahead_rad = np.array([wish.heading_rad])
    clearance_m = float(obstacles.clearance_m(ahead_rad, limits.disc_m(wish.speed_fraction))[0])
    if clearance_m < limits.needed_m(wish):
        return None
    return Steering(wish.heading_rad, False, "free", clearance_m, speed_fraction=wish.speed_fraction)


def _follow_border(
    wish: Wish, obstacles: Obstacles, memory: Passing, limits: PassingLimits
) -> tuple[Steering, Passing]:
    """The same at this share of full speed, where something is in the way."""
    wished_rad = wish.heading_rad
    lookahead_m, radius_m = limits.needed_m(wish), limits.disc_m(wish.speed_fraction)
    if memory.steps > limits.patience_steps * limits.patience_growth**memory.tries:
        memory = Passing(side=-memory.side, tries=memory.tries + 1, wished_rad=wished_rad)
    straight = _straight_on(wish, obstacles, memory, limits)
    if straight is not None:
        return straight, memory.rested(limits)
    side = memory.side
    if memory.deflection_rad == 0.0:
        side = _easier_side(wished_rad, obstacles, lookahead_m, radius_m, memory.side)
    first_rad = max(0.0, memory.deflection_rad - BACKTRACK_RAD)
    offsets_rad = np.arange(first_rad, first_rad + FULL_TURN_RAD, STEP_RAD)
    headings_rad = wished_rad + side * offsets_rad
    clearances_m = obstacles.clearance_m(headings_rad, radius_m)
    onward_m = clearances_m[offsets_rad <= ONWARD_RAD]
    chosen = _first_free(onward_m, lookahead_m, SQUEEZE_SHARE * lookahead_m)
    if chosen is None:
        chosen = _first_free(clearances_m, lookahead_m, limits.lookahead_min_m)
    if chosen is None:
        return Steering(wished_rad, True, "no free direction", 0.0, True), replace(memory, side=side)
    deflection_rad = float(offsets_rad[chosen])
    name = "left" if side > 0 else "right"
    why = f"passing on the {name}, {math.degrees(deflection_rad):.0f} deg off"
    heading_rad, clearance_m = _wrap(float(headings_rad[chosen])), float(clearances_m[chosen])
    steering = Steering(heading_rad, True, why, clearance_m, speed_fraction=wish.speed_fraction)
    return steering, replace(
        memory, side=side, deflection_rad=deflection_rad, steps=memory.steps + 1, idle_steps=0
    )


def _first_free(clearances_m: FloatArray, *enough_m: float) -> int | None:
    """Index of the first direction with the first clearance that any has; None where none has the last."""
    for least_m in enough_m:
        free = np.flatnonzero(clearances_m >= least_m)
        if len(free):
            return int(free[0])
    return None


def _easier_side(
    wished_rad: float, obstacles: Obstacles, lookahead_m: float, radius_m: float, remembered: int
) -> int:
    """The side with a free direction nearer to the wished one; the remembered one unless far worse."""
    offsets_rad = np.arange(STEP_RAD, FULL_TURN_RAD, STEP_RAD)
    best: dict[int, float] = {}
    for side in (1, -1):
        free = obstacles.clearance_m(wished_rad + side * offsets_rad, radius_m) >= lookahead_m
        best[side] = float(offsets_rad[free.argmax()]) if free.any() else FULL_TURN_RAD
    if remembered and best[remembered] <= best[-remembered] + PREFERENCE_RAD:
        return remembered
    return 1 if best[1] <= best[-1] else -1


def _wrap(angle_rad: float) -> float:
    return math.remainder(angle_rad, FULL_TURN_RAD)


def obstacle_heading(
    angles_rad: tuple[float, ...], distances_m: tuple[float, ...], range_m: float
) -> float | None:
    """The thesis's direction of obstacles nearer than `range_m` (section 4.3): sum of their unit vectors."""
    near = [angle for angle, distance in zip(angles_rad, distances_m, strict=True) if distance < range_m]
    if not near:
        return None
    return math.atan2(sum(map(math.sin, near)), sum(map(math.cos, near)))


def steer_away(heading_rad: float, obstacle_rad: float | None, rng: np.random.Generator) -> Steering:
    """Blend w1 (away from the obstacle) with 1 - w1 (the estimate), w1 uniform in (0.5, 1.0), figure 4.9."""
    if obstacle_rad is None:
        return Steering(heading_rad, False, "free")
    weight = float(rng.uniform(0.5, 1.0))
    x = (1.0 - weight) * math.cos(heading_rad) - weight * math.cos(obstacle_rad)
    y = (1.0 - weight) * math.sin(heading_rad) - weight * math.sin(obstacle_rad)
    return Steering(math.atan2(y, x), True, f"away from obstacle at {math.degrees(obstacle_rad):.0f} deg")
