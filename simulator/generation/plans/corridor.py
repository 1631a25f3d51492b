"""Rooms on both sides of a corridor: hostels, hotels, schools, offices. Pure."""

from dataclasses import dataclass

import numpy as np

from simulator.generation.plans.rectangles import WALL_M, Plan, Rect, RoomPlan

LOBBY_M = 4.0
"""Length of the room at the end of a corridor; chosen."""
FROM_CORNER_M = 0.5
"""Between a doorway and the nearest corner: a leaf fits."""


@dataclass(frozen=True)
class CorridorStyle:
    """What the rooms of a corridor are, metres.

    Attributes:
        use: of the rooms.
        width_m, depth_m: least and most of a room, along the corridor and away from it.
        corridor_m: least and most width of the corridor.
        per_side: rooms on each side by size.
        alike: rooms are furnished alike.
        other: use of some rooms.
        other_share: of how many.
    """

    use: str
    width_m: tuple[float, float]
    depth_m: tuple[float, float]
    corridor_m: tuple[float, float]
    per_side: tuple[int, int, int]
    alike: bool = False
    other: str = ""
    other_share: float = 0.0


def corridor_plan(style: CorridorStyle, size: int, rng: np.random.Generator) -> Plan:
    """A corridor along x from a lobby, equal rooms north and south of it.

    Args:
        style: what the rooms are.
        size: 0 to 2.
        rng: draws the measures.
    """
    wide_m, deep_m, broad_m = (
        round(float(rng.uniform(*bounds)), 1) for bounds in (style.width_m, style.depth_m, style.corridor_m)
    )
    door_m = round(float(rng.uniform(1.0, 1.2)), 2)
    count = style.per_side[size]
    long_m = round(WALL_M + count * (wide_m + WALL_M), 3)
    corridor = Rect(0.0, 0.0, long_m, broad_m)
    lobby = Rect(-LOBBY_M, -1.0, 0.0, broad_m + 1.0)
    rooms = [RoomPlan("lobby", "lobby", lobby), RoomPlan("corridor", "corridor", corridor)]
    doors = []
    at_m = FROM_CORNER_M + float(rng.uniform(0.0, wide_m - door_m - 2 * FROM_CORNER_M)) * 0.3
    for k in range(count):
        x0 = WALL_M + k * (wide_m + WALL_M)  # the lobby's wall lies before the first room
        for side, y0 in (("north", broad_m + WALL_M), ("south", -WALL_M - deep_m)):
            use = style.other if style.other and rng.random() < style.other_share else style.use
            rooms.append(RoomPlan(f"{side} {k + 1}", use, Rect(x0, y0, x0 + wide_m, y0 + deep_m)))
            # A room of the south side is one of the north side turned by 180 degrees.
            left = x0 + at_m if side == "north" else x0 + wide_m - at_m - door_m
            wall = broad_m if side == "north" else -WALL_M
            doors.append(Rect(left, wall, left + door_m, wall + WALL_M))
    alike = frozenset({style.use}) if style.alike else frozenset()
    return Plan(tuple(rooms), tuple(doors), (-LOBBY_M / 2, broad_m / 2), alike)
