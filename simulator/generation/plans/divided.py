"""Flats: a rectangle divided into rooms, and doorways until every room can be reached. Pure."""

import numpy as np

from simulator.generation.plans.rectangles import TOUCH_M, WALL_M, Plan, Rect, RoomPlan

SIDES_M = ((7.0, 6.0), (10.0, 8.0), (13.0, 10.0))
"""Of the whole flat by size; a metre more or less is drawn."""
LEAST_M = 2.6
"""Side of a room; chosen: a bed and a way past it."""
LARGE_M = 5.2
"""A room with a longer side is divided again; chosen."""
DOOR_M = 1.1
FROM_CORNER_M = 0.3
SECOND_DOOR = 0.2
"""Probability of a doorway more than needed between two rooms: some flats have a way round."""
USES = ("bedroom", "kitchen", "study", "bedroom", "hall")


def divided_plan(size: int, rng: np.random.Generator) -> Plan:
    """Rooms of a flat, the largest the living room.

    Args:
        size: 0 to 2.
        rng: draws walls and doorways.
    """
    wide_m, deep_m = (round(side + float(rng.uniform(-0.8, 0.8)), 1) for side in SIDES_M[size])
    rects = sorted(_divided(Rect(0.0, 0.0, wide_m, deep_m), rng), key=lambda rect: -rect.area_m2)
    uses = ("living", *(USES[k % len(USES)] for k in range(len(rects) - 1)))
    rooms = tuple(
        RoomPlan(f"{use} {k}", use, rect) for k, (use, rect) in enumerate(zip(uses, rects, strict=True))
    )
    return Plan(rooms, tuple(_doors(rects, rng)), rects[0].centre_m)


def _divided(rect: Rect, rng: np.random.Generator) -> list[Rect]:
    long_m = max(rect.size_m)
    if long_m <= LARGE_M or long_m < 2 * LEAST_M + WALL_M:
        return [rect]
    at_m = round(float(rng.uniform(LEAST_M, long_m - LEAST_M - WALL_M)), 1)
    if rect.size_m[0] >= rect.size_m[1]:
        cut = rect.x0 + at_m
        parts = Rect(rect.x0, rect.y0, cut, rect.y1), Rect(cut + WALL_M, rect.y0, rect.x1, rect.y1)
    else:
        cut = rect.y0 + at_m
        parts = Rect(rect.x0, rect.y0, rect.x1, cut), Rect(rect.x0, cut + WALL_M, rect.x1, rect.y1)
    return [piece for part in parts for piece in _divided(part, rng)]


def _doors(rects: list[Rect], rng: np.random.Generator) -> list[Rect]:
    """Doorways: a random spanning tree of the rooms, and a few more."""
    walls = {
        (a, b): wall for a in range(len(rects)) for b in range(a) if (wall := _between(rects[a], rects[b]))
    }
    group = list(range(len(rects)))
    doors = []
    for a, b in rng.permutation(sorted(walls)).tolist():
        if group[a] == group[b] and rng.random() > SECOND_DOOR:
            continue
        group = [group[a] if one == group[b] else one for one in group]
        doors.append(_doorway(walls[a, b], rng))
    return doors


def _between(a: Rect, b: Rect) -> Rect | None:
    """The wall between two rooms where a doorway fits; None where there is none."""
    x0, x1 = max(a.x0, b.x0), min(a.x1, b.x1)
    y0, y1 = max(a.y0, b.y0), min(a.y1, b.y1)
    least_m = DOOR_M + 2 * FROM_CORNER_M
    if x1 - x0 >= least_m and abs(y0 - y1 - WALL_M) < TOUCH_M:
        return Rect(x0, y1, x1, y0)
    if y1 - y0 >= least_m and abs(x0 - x1 - WALL_M) < TOUCH_M:
        return Rect(x1, y0, x0, y1)
    return None


def _doorway(wall: Rect, rng: np.random.Generator) -> Rect:
    free = max(wall.size_m) - DOOR_M - 2 * FROM_CORNER_M
    at_m = FROM_CORNER_M + round(float(rng.uniform(0.0, free)), 2)
    if wall.size_m[0] > wall.size_m[1]:
        return Rect(wall.x0 + at_m, wall.y0, wall.x0 + at_m + DOOR_M, wall.y1)
    return Rect(wall.x0, wall.y0 + at_m, wall.x1, wall.y0 + at_m + DOOR_M)
