"""Getting round furniture: follow its border until the way ahead is free and all turning is undone.

The rule is Pledge's (Abelson and diSessa, Turtle Geometry, 1981) with a compass that is the planner's
heading: the deflection from the wished heading is counted, also beyond half a turn, and the border is left
only when it has come back to zero. A side that does not lead past in time is given up for the other, with
twice the patience each time: without a map of the obstacle no search wastes less. This memory ages in steps.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat, PositiveInt

from services.drive.steering import Steering
from shared.geometry.clearance import Obstacles

STEP_RAD = math.radians(10.0)
BACKTRACK_RAD = math.radians(100.0)
LOYALTY_RAD = math.radians(50.0)
JUMP_RAD = math.radians(60.0)
"""A wish that changes this much between two steps is another errand."""
FULL_TURN_RAD = 2.0 * math.pi


class PassingLimits(BaseModel):
    """Sizes of the robot and patience of the rule."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    radius_m: PositiveFloat = 0.29
    radius_slow_m: PositiveFloat = 0.275
    lookahead_m: PositiveFloat = 0.45
    lookahead_min_m: PositiveFloat = 0.12
    memory_steps: PositiveInt = 15
    patience_steps: PositiveInt = 14
    patience_growth: PositiveFloat = 2.0


@dataclass(frozen=True)
class Passing:
    """Memory between steps.

    Attributes:
        side: +1 passes obstacles with turns to the left, -1 to the right, 0 undecided.
        deflection_rad: turning away from the wished heading so far, towards `side`, never negative.
        steps: steps on this border; idle_steps: steps since it was left.
        wished_rad: the wish of the previous step.
        turns_back: times the side was changed on this border; each doubles the patience.
    """

    side: int = 0
    deflection_rad: float = 0.0
    steps: int = 0
    idle_steps: int = 0
    turns_back: int = 0
    wished_rad: float | None = None

    def towards(self, wished_rad: float) -> "Passing":
        """The memory for a new wish: the border is kept while the wish drifts, forgotten when it jumps."""
        if self.wished_rad is None:
            return replace(self, wished_rad=wished_rad)
        change_rad = _wrap(wished_rad - self.wished_rad)
        if abs(change_rad) > JUMP_RAD:
            return Passing(wished_rad=wished_rad)
        turned_rad = max(0.0, self.deflection_rad - self.side * change_rad) if self.deflection_rad else 0.0
        return replace(self, deflection_rad=turned_rad, wished_rad=wished_rad)


def steer_past(
    wished_rad: float, obstacles: Obstacles, memory: Passing, speed_fraction: float, limits: PassingLimits
) -> tuple[Steering, Passing]:
    """Choose the direction nearest to the wished one that keeps the border on the chosen side.

    Args:
        wished_rad: where the planner wants to go, robot frame.
        obstacles: what the distance sensors see.
        memory: result of the previous step.
        speed_fraction: the planner's limit; a slow robot near its goal looks less far ahead.
        limits: sizes and patience.
    """
    memory = memory.towards(wished_rad)
    span_m = limits.lookahead_m - limits.lookahead_min_m
    lookahead_m = limits.lookahead_min_m + span_m * speed_fraction
    radius_m = limits.radius_slow_m + (limits.radius_m - limits.radius_slow_m) * speed_fraction
    if memory.steps > limits.patience_steps * limits.patience_growth**memory.turns_back:
        memory = Passing(side=-memory.side, turns_back=memory.turns_back + 1, wished_rad=wished_rad)
    if memory.deflection_rad == 0.0:
        clearance_m = float(obstacles.clearance_m(np.array([wished_rad]), radius_m)[0])
        if clearance_m >= lookahead_m:
            idle = memory.idle_steps + 1
            kept = replace(memory, steps=max(0, memory.steps - 1), idle_steps=idle)
            kept = kept if idle < limits.memory_steps else Passing(wished_rad=wished_rad)
            return Steering(wished_rad, False, "free", clearance_m), kept
    side = memory.side
    if memory.deflection_rad == 0.0:
        side = _easier_side(wished_rad, obstacles, lookahead_m, radius_m, memory.side)
    first_rad = max(0.0, memory.deflection_rad - BACKTRACK_RAD)
    offsets_rad = np.arange(first_rad, first_rad + FULL_TURN_RAD, STEP_RAD)
    headings_rad = wished_rad + side * offsets_rad
    clearances_m = obstacles.clearance_m(headings_rad, radius_m)
    free = np.flatnonzero(clearances_m >= lookahead_m)
    if not len(free):
        free = np.flatnonzero(clearances_m >= limits.lookahead_min_m)
    if not len(free):
        return Steering(wished_rad, True, "no free direction", 0.0, True), replace(memory, side=side)
    chosen = int(free[0])
    deflection_rad = float(offsets_rad[chosen])
    name = "left" if side > 0 else "right"
    why = f"passing on the {name}, {math.degrees(deflection_rad):.0f} deg off"
    steering = Steering(_wrap(float(headings_rad[chosen])), True, why, float(clearances_m[chosen]))
    return steering, replace(
        memory, side=side, deflection_rad=deflection_rad, steps=memory.steps + 1, idle_steps=0
    )


def _easier_side(
    wished_rad: float, obstacles: Obstacles, lookahead_m: float, radius_m: float, remembered: int
) -> int:
    """The side with a free direction nearer to the wished one; the remembered one unless far worse."""
    offsets_rad = np.arange(STEP_RAD, FULL_TURN_RAD, STEP_RAD)
    best: dict[int, float] = {}
    for side in (1, -1):
        free = obstacles.clearance_m(wished_rad + side * offsets_rad, radius_m) >= lookahead_m
        best[side] = float(offsets_rad[free.argmax()]) if free.any() else FULL_TURN_RAD
    if remembered and best[remembered] <= best[-remembered] + LOYALTY_RAD:
        return remembered
    return 1 if best[1] <= best[-1] else -1


def _wrap(angle_rad: float) -> float:
    return math.remainder(angle_rad, FULL_TURN_RAD)
