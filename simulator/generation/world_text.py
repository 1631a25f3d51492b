"""A generated world as the contents and the text of a world file."""

import math
from pathlib import Path
from typing import Any

import yaml

from simulator.generation.palettes import Palette
from simulator.generation.pieces import Placed
from simulator.generation.plans.rectangles import Plan, Point, Rect, RoomPlan
from simulator.world.world_file import WorldFile, load_world


def shell(name: str, wall_height_m: float, plan: Plan, look: Palette) -> dict[str, Any]:
    """Everything but furniture; rooms of the same use have the same floor and walls."""
    surfaces: dict[str, dict[str, Any]] = {}
    rooms, grounds = [], []
    for room in plan.rooms:
        if room.border:
            floor = look.ground(room.use)
            grounds.append({"name": room.name, **_box(room.rect), "floor": floor, "border": room.border})
            continue
        if room.use not in surfaces:
            surfaces[room.use] = {"floor": look.floor(), "walls": look.walls(), "ceiling": look.ceiling()}
        rooms.append({"name": room.name, **_box(room.rect), **surfaces[room.use]})
    doorway = rooms[0]["floor"] if rooms else {}
    open_air = {"environment": "outdoor", "sky": {"seed": 3}, "sun": {}} if grounds else {}
    return {
        "format": "topnav-world/1",
        "name": name,
        **open_air,
        "wall_height_m": wall_height_m,
        "alike": bool(plan.alike),
        "start": {"x_m": _mm(plan.start[0]), "y_m": _mm(plan.start[1])},
        "rooms": rooms,
        "grounds": grounds,
        "openings": [{**_box(door), "floor": doorway} for door in plan.doors],
    }


def one_room(room: RoomPlan, start: Point, look: Palette) -> dict[str, Any]:
    """A room without its doorways, as a world of its own."""
    return shell(room.name, 2.6, Plan((room,), (), start), look)


def furnished(world: dict[str, Any], pieces: list[Placed]) -> dict[str, Any]:
    """With furniture."""
    return {**world, "furniture": [_item(piece) for piece in pieces]}


def as_yaml(world: dict[str, Any]) -> str:
    """A world file: a line for each room and piece, as people write them."""
    lines = []
    for key, value in world.items():
        if value == []:
            continue
        if isinstance(value, list):
            lines.append(f"{key}:")
            lines += [f"  - {_flow(one)}" for one in value]
        else:
            lines.append(f"{key}: {_flow(value)}")
    return "\n".join(lines) + "\n"


def write_world(path: Path, world: dict[str, Any]) -> WorldFile:
    """Write a world file, and read it as anybody's.

    Raises:
        WorldFileError: it cannot be used.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(as_yaml(world), encoding="utf-8")
    return load_world(str(path))


def _flow(value: object) -> str:
    text = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=math.inf)
    return text.strip().removesuffix("...").strip()


def _item(piece: Placed) -> dict[str, Any]:
    item: dict[str, Any] = {"kind": piece.kind, "at_m": list(piece.at_m)}
    for key, value in (("yaw_deg", round(piece.yaw_deg, 1)), ("z_m", piece.z_m), ("seed", piece.seed)):
        if value:
            item[key] = value
    return {**item, **({"options": piece.options} if piece.options else {})}


def _box(rect: Rect) -> dict[str, list[float]]:
    return {"x_m": [_mm(rect.x0), _mm(rect.x1)], "y_m": [_mm(rect.y0), _mm(rect.y1)]}


def _mm(value: float) -> float:
    return round(value, 3)
