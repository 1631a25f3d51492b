"""Rooms furnished alike, as in hostels: the furniture of one in the others, but for small things. Pure."""

import numpy as np

from simulator.generation.pieces import Placed, piece_at
from simulator.generation.plans.rectangles import WALL_M, Plan, RoomPlan

CHANGED = 0.15
"""Share of small things that are missing or look otherwise; chosen: one or two in a room."""
SMALL = ("picture", "plant", "basket", "backpack", "pouf", "floor_lamp", "rug", "chair")
"""What may differ."""


def furnished_like(
    model: RoomPlan, placed: list[Placed], room: RoomPlan, plan: Plan, rng: np.random.Generator
) -> list[Placed]:
    """The furniture of a room in another one of its size, turned as its doorway is.

    Args:
        model: the room that is furnished.
        placed: its furniture.
        room: the other one.
        plan: where the doorways of both are.
        rng: draws what differs.
    """
    turned = door_is_south(model, plan) != door_is_south(room, plan)
    (x0, y0), (x1, y1) = model.rect.centre_m, room.rect.centre_m
    sign, turn_deg = (-1.0, 180.0) if turned else (1.0, 0.0)
    found = []
    for piece in placed:
        drawn = rng.random()
        if piece.kind in SMALL and drawn < CHANGED / 2:
            continue
        seed = piece.seed + 1 if piece.kind in SMALL and drawn < CHANGED else piece.seed
        at_m = round(x1 + sign * (piece.at_m[0] - x0), 3), round(y1 + sign * (piece.at_m[1] - y0), 3)
        found.append(piece_at(piece.kind, at_m, piece.yaw_deg + turn_deg, seed, piece.options, piece.z_m))
    return found


def door_is_south(room: RoomPlan, plan: Plan) -> bool:
    """On which of two sides of a corridor a room lies: those opposite are furnished the other way round."""
    door = next(door for door in plan.doors if door.gap_m(room.rect) <= WALL_M / 2)
    return door.centre_m[1] < room.rect.centre_m[1]
