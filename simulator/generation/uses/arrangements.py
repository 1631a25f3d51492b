"""Furniture that belongs together, and what a room has several of. Each as far as there is space."""

import math
from typing import Any

import numpy as np

from simulator.generation.palettes import Palette
from simulator.generation.pieces import Placed
from simulator.generation.placing import ROW_SEED, Furnisher

STYLES = ("landscape", "street", "abstract", "still_life", "poster")


def before(piece: Placed, ahead_m: float) -> tuple[float, float]:
    """A point before a piece's origin."""
    yaw_rad = math.radians(piece.yaw_deg)
    return piece.at_m[0] + ahead_m * math.cos(yaw_rad), piece.at_m[1] + ahead_m * math.sin(yaw_rad)


def desk_with_chair(room: Furnisher, palette: Palette, chair: str, options: dict[str, Any]) -> None:
    """A desk at a wall with its chair."""
    desk = room.against_wall("desk", {"colour": palette.wood, **options}, front_m=0.45)
    if desk is not None:
        depth_m = float(options.get("depth_m", 0.8))
        seat = {"cushion": palette.cloth()} if chair == "chair" else {"colour": palette.cloth()}
        turn_deg = float(room.rng.uniform(-20.0, 20.0))
        room.at(chair, before(desk, depth_m + 0.12), desk.yaw_deg + 180.0 + turn_deg, seat)


def table_with_chairs(room: Furnisher, palette: Palette, kind: str, chairs: int) -> None:
    """A table in the open with chairs round it."""
    around_m = 0.35 if chairs else 0.0
    table = room.in_the_open(kind, {"colour": palette.wood}, around_m=around_m)
    if table is None:
        return
    half_x, half_y = (side / 2 - around_m + 0.1 for side in table.box.size_m)
    for k in range(chairs):
        angle_rad = math.tau * (k + 0.5) / chairs
        x, y = half_x * math.cos(angle_rad), half_y * math.sin(angle_rad)
        seat = {"cushion": palette.cloth()}
        towards_deg = math.degrees(math.atan2(-y, -x))
        room.at("chair", (table.at_m[0] + x, table.at_m[1] + y), round(towards_deg, 1), seat)


def rows_of_desks(room: Furnisher, palette: Palette, columns_m: float, rows_m: float) -> None:
    """Small desks one behind the other, each with a chair."""
    desk = {"width_m": 1.2, "depth_m": 0.5, "screens": 0, "colour": palette.wood}
    seat = {"cushion": palette.cloths[0], "colour": palette.wood}
    for x, middle in grid(room, 1.2 + columns_m - 0.3, 0.5 + rows_m):
        y = middle - 0.5  # desk and chair together in the middle
        if room.stand("desk", (x, y), 90.0, desk, front_m=0.5):
            room.at("chair", (x, y + 0.62), -90.0, seat, seed=ROW_SEED)


def desk_island(room: Furnisher, palette: Palette, x: float, y: float) -> None:
    """Two desks back to back, with their chairs."""
    desk = {"width_m": 1.6, "depth_m": 0.7, "colour": palette.wood}
    if room.stand("desk", (x, y), 90.0, desk, front_m=0.45, both=True):
        room.at("desk", (x, y), -90.0, desk, seed=ROW_SEED)
        seat = {"colour": palette.cloths[0]}
        for side, yaw_deg in ((1.0, -90.0), (-1.0, 90.0)):
            turned_deg = yaw_deg + round(float(room.rng.uniform(-25.0, 25.0)), 1)
            room.at("office_chair", (x, y + 0.82 * side), turned_deg, seat, seed=ROW_SEED)


def grid(room: Furnisher, x_m: float, y_m: float) -> list[tuple[float, float]]:
    """Points so far apart that fill a room evenly."""
    (wide_m, deep_m), (x, y) = room.rect.size_m, room.rect.centre_m
    columns, rows = max(1, int((wide_m - 1.0) // x_m)), max(1, int((deep_m - 1.0) // y_m))
    xs = [round(x + x_m * (k - (columns - 1) / 2), 3) for k in range(columns)]
    ys = [round(y + y_m * (k - (rows - 1) / 2), 3) for k in range(rows)]
    return [(one, other) for other in ys for one in xs]


def rug(room: Furnisher, palette: Palette, length_m: float, width_m: float) -> None:
    """In the middle of a room."""
    styles = ("persian", "modern", "kilim")
    style = styles[int(room.rng.integers(len(styles)))]
    options = {"length_m": length_m, "width_m": width_m, "style": style, "colour": palette.cloth()}
    room.at("rug", room.rect.centre_m, 90.0 * int(room.rng.integers(2)), options)


def window(room: Furnisher, palette: Palette) -> None:
    """A window with a view on an outer wall."""
    room.on_wall("window", 0.9, {"curtain": list(palette.cloths[-1])}, daylight=True)


def pictures(room: Furnisher, count: int) -> None:
    """Pictures."""
    for _ in range(count):
        options: dict[str, Any] = {
            "style": STYLES[int(room.rng.integers(len(STYLES)))],
            "width_m": round(float(room.rng.choice(np.array([0.45, 0.6, 0.8, 1.0]))), 2),
            "variant": int(room.rng.integers(4)),
        }
        room.on_wall("picture", round(float(room.rng.uniform(1.45, 1.75)), 2), options)


def clutter(room: Furnisher, palette: Palette, count: int) -> None:
    """Clutter along the walls."""
    for _ in range(count):
        kind = ("plant", "basket", "backpack", "pouf", "floor_lamp")[int(room.rng.integers(5))]
        options = (
            {"height_m": 1.1} if kind == "plant" else {"colour": palette.cloth()} if kind == "pouf" else {}
        )
        room.against_wall(kind, options, centred=True)
