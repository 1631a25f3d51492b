"""One large hall with a few small rooms beside it: warehouses, shops, open-plan offices. Pure."""

from dataclasses import dataclass

import numpy as np

from simulator.generation.plans.rectangles import WALL_M, Plan, Rect, RoomPlan

SIDE_ROOM_M = (3.2, 4.2)
"""Least and most of a side room, either way."""
DOOR_M = 1.2


@dataclass(frozen=True)
class HallStyle:
    """What a hall is.

    Attributes:
        use: of the hall.
        sides_m: of the hall by size; a tenth more or less is drawn.
        beside: uses of the rooms beside it, as many as the size allows.
    """

    use: str
    sides_m: tuple[tuple[float, float], ...]
    beside: tuple[str, ...]


def hall_plan(style: HallStyle, size: int, rng: np.random.Generator) -> Plan:
    """A hall, and rooms along its east side.

    Args:
        style: what it is.
        size: 0 to 2.
        rng: draws the measures.
    """
    wide_m, deep_m = (round(side * float(rng.uniform(0.9, 1.1)), 1) for side in style.sides_m[size])
    rooms = [RoomPlan("hall", style.use, Rect(0.0, 0.0, wide_m, deep_m))]
    doors, y0 = [], 0.0
    for k, use in enumerate(style.beside[: size + 1]):
        broad_m, long_m = (round(float(side), 1) for side in rng.uniform(*SIDE_ROOM_M, size=2))
        if y0 + long_m > deep_m:
            break
        x0 = wide_m + WALL_M
        rooms.append(RoomPlan(f"{use} {k + 1}", use, Rect(x0, y0, x0 + broad_m, y0 + long_m)))
        at_m = y0 + round(float(rng.uniform(0.4, long_m - DOOR_M - 0.4)), 2)
        doors.append(Rect(wide_m, at_m, x0, at_m + DOOR_M))
        y0 += long_m + WALL_M
    return Plan(tuple(rooms), tuple(doors), (1.0, deep_m / 2))
