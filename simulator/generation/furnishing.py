"""Furniture for every room of a plan: drawn room by room, or once for all that are alike. Pure."""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from simulator.generation.alike import furnished_like
from simulator.generation.mending import mended
from simulator.generation.palettes import Palette
from simulator.generation.pieces import YAWS, Placed, piece_at
from simulator.generation.placing import Furnisher
from simulator.generation.plans.rectangles import WALL_M, Plan, Rect, RoomPlan, ways_through
from simulator.generation.uses import halls, homes, outdoors, public_rooms
from simulator.generation.world_text import furnished, one_room
from simulator.world.world_file import WorldFile

USES: dict[str, Callable[[Furnisher, Palette], None]] = {
    name: function
    for module in (homes, public_rooms, halls, outdoors)
    for name, function in vars(module).items()
    if inspect.isfunction(function) and function.__module__ == module.__name__ and not name.startswith("_")
}
"""What furnishes a piece of floor, by its use: every public function of these modules."""
LIGHT_EVERY_M = 3.6
BEFORE_DOOR_M = 0.95
"""Floor that stays free before and behind a doorway: one can turn there."""


def furnish(plan: Plan, palette: Palette, ceiling_m: float, rng: np.random.Generator) -> list[Placed]:
    """Furniture of all rooms.

    Args:
        plan: rooms and doorways.
        palette: what things are made of.
        ceiling_m: where lamps hang.
        rng: draws everything.
    """
    found: list[Placed] = []
    models: dict[tuple[str, float, float], tuple[RoomPlan, list[Placed]]] = {}
    for room in plan.rooms:
        wide_m, deep_m = room.rect.size_m
        key = (room.use, round(wide_m, 3), round(deep_m, 3))
        if room.use in plan.alike and key in models:
            model, placed = models[key]
            found += furnished_like(model, placed, room, plan, rng)
            continue
        placed = _furnished(room, plan, palette, rng)
        if not room.border:
            placed += _lamps(room.rect, ceiling_m)
        models[key] = (room, placed)
        found += placed
    return found


def _furnished(room: RoomPlan, plan: Plan, palette: Palette, rng: np.random.Generator) -> list[Placed]:
    doors = [door for door in plan.doors if door.gap_m(room.rect) <= WALL_M / 2]
    others = [other for other in plan.rooms if other is not room]
    start = Rect(*plan.start, *plan.start).grown(0.5)
    open_to = [other.rect.grown(BEFORE_DOOR_M) for other in others if other.rect.gap_m(room.rect) <= 0.0]
    ways = [ways_through(door, BEFORE_DOOR_M) for door in doors]
    gaps = doors + [other.rect for other in others]
    furnisher = Furnisher(room.rect, [start, *ways, *open_to], gaps, _outside(room, others), rng)
    USES[room.use](furnisher, palette)
    entry = next(iter(doors), start).centre_m
    world = one_room(room, room.rect.grown(-BEFORE_DOOR_M / 2).nearest(entry), palette)
    return mended(furnisher.placed, lambda some: WorldFile.model_validate(furnished(world, some)))


def _outside(room: RoomPlan, others: list[RoomPlan]) -> frozenset[float]:
    """Yaws of the walls with no room behind them anywhere."""
    r = room.rect
    strips = (
        Rect(r.x0 - 1.0, r.y0, r.x0 - 0.05, r.y1),
        Rect(r.x0, r.y0 - 1.0, r.x1, r.y0 - 0.05),
        Rect(r.x1 + 0.05, r.y0, r.x1 + 1.0, r.y1),
        Rect(r.x0, r.y1 + 0.05, r.x1, r.y1 + 1.0),
    )
    free = zip(YAWS, strips, strict=True)
    return frozenset(yaw for yaw, strip in free if all(strip.gap_m(other.rect) >= 0.0 for other in others))


def _lamps(rect: Rect, ceiling_m: float) -> list[Placed]:
    counts = [max(1, round(side / LIGHT_EVERY_M)) for side in rect.size_m]
    options: dict[str, Any] = {"strength": 2.6 if ceiling_m < 4.0 else 6.0}
    lamps = []
    for a in range(counts[0]):
        for b in range(counts[1]):
            x = round(rect.x0 + rect.size_m[0] * (a + 0.5) / counts[0], 3)
            y = round(rect.y0 + rect.size_m[1] * (b + 0.5) / counts[1], 3)
            lamps.append(piece_at("ceiling_light", (x, y), 0.0, 0, options, ceiling_m))
    return lamps
