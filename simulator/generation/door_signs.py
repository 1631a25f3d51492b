"""Numbers beside the doors of a corridor, drawn apart from everything else in a world. Pure."""

from typing import Any

import numpy as np

from simulator.generation.extents import extent
from simulator.generation.pieces import Placed, piece_at
from simulator.generation.plans.rectangles import WALL_M, Plan, Rect

CENTRE_M = 1.45
"""Height of a plate's centre; chosen: eye level, as building codes have it (1.2 to 1.5 m)."""
BESIDE_M = (0.22, 0.35, 0.48, 0.61)
"""From the edge of the doorway to the middle of the plate: the nearest at which nothing hides it."""
LINTEL_M = 2.27
"""Height of a plate over a doorway of 2.1 m, where there is no free wall beside it."""
FREE_M, BEFORE_M = 0.04, 0.4
"""Beside and in front of a plate, free of furniture and pictures."""
SIZES_M = ((0.24, 0.15), (0.28, 0.18), (0.3, 0.2))
LOOKS = ("white", "blue", "steel")
FLOORS = 5
CORRIDOR = "corridor"


def door_signs(plan: Plan, pieces: list[Placed], rng: np.random.Generator) -> list[Placed]:
    """A plate with a number at every doorway from a corridor into a room, on the corridor's wall.

    Odd numbers on one side, even ones on the other, as along a street; all plates of a building are alike.

    Args:
        plan: rooms and doorways.
        pieces: what stands and hangs there already.
        rng: draws the floor, the first number and the plates.
    """
    first = 100 * int(rng.integers(1, FLOORS + 1)) + 1 + 2 * int(rng.integers(0, 20))
    wide_m, high_m = SIZES_M[int(rng.integers(len(SIZES_M)))]
    options: dict[str, Any] = {"width_m": wide_m, "height_m": high_m, "look": LOOKS[int(rng.integers(3))]}
    corridors = [room.rect for room in plan.rooms if room.use == CORRIDOR]
    found = []
    for north in (True, False):
        doors = [door for corridor in corridors for door in _doors(plan, corridor, north)]
        for k, door in enumerate(sorted(doors, key=lambda door: door.x0)):
            number = str(first + 2 * k + (not north))
            found.append(_at_door(door, north, {"text": number, **options}, pieces))
    return found


def _doors(plan: Plan, corridor: Rect, north: bool) -> list[Rect]:
    edge = corridor.y1 if north else corridor.y0
    return [door for door in plan.doors if abs((door.y0 if north else door.y1) - edge) < WALL_M / 2]


def _at_door(door: Rect, north: bool, options: dict[str, Any], pieces: list[Placed]) -> Placed:
    """Rather on the right hand of who stands before the doorway, rather near it."""
    wall, yaw_deg = (door.y0, -90.0) if north else (door.y1, 90.0)
    right, left = (door.x1, door.x0) if north else (door.x0, door.x1)
    out = 1.0 if north else -1.0
    for beside in BESIDE_M:
        for x in (right + out * beside, left - out * beside):
            sign = piece_at("door_sign", (round(x, 3), round(wall, 3)), yaw_deg, 0, options, CENTRE_M)
            if not any(_hides(piece, sign) for piece in pieces):
                return sign
    at_m = round(door.centre_m[0], 3), round(wall, 3)
    return piece_at("door_sign", at_m, yaw_deg, 0, options, LINTEL_M)


def _hides(piece: Placed, sign: Placed) -> bool:
    size = extent(piece.kind, piece.options, piece.seed)
    half = sign.options["height_m"] / 2 + FREE_M
    above = piece.z_m + size.low_m > sign.z_m + half
    below = piece.z_m + size.high_m < sign.z_m - half
    return not (above or below) and piece.box.gap_m(sign.longer(BEFORE_M).box.grown(FREE_M)) < 0.0
