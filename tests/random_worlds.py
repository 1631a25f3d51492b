"""Worlds that nobody tuned: random rooms or grounds with furniture and a model, as data of a world file."""

from pathlib import Path
from typing import Any

import numpy as np

FLOOR_PIECES = ("armchair", "basket", "chair", "coffee_table", "plant", "pouf", "dining_table", "sofa")
WALL_PIECES = ("picture", "clock", "door", "mirror", "radiator")
WALL_M = 0.15
DOOR_M = 1.2
CRATE = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""


def random_world(seed: int, outdoor: bool, folder: Path) -> dict[str, Any]:
    """A row of two or three areas, each joined to the next; its model is written into the folder."""
    rng = np.random.default_rng(seed)
    (folder / "crate.obj").write_text(CRATE, encoding="utf-8")
    areas: list[dict[str, Any]] = []
    openings: list[dict[str, Any]] = []
    furniture: list[dict[str, Any]] = []
    west = float(rng.uniform(-20, 20))
    for k in range(int(rng.integers(2, 4))):
        x = (west, west + float(rng.uniform(3.5, 9.0)))
        y = (float(rng.uniform(-5.0, -2.0)), float(rng.uniform(2.0, 5.0)))
        areas.append(_area(rng, f"area {k}", x, y, outdoor))
        furniture += _furnished(rng, x, y, outdoor)
        if k:
            openings.append(
                {
                    "x_m": [x[0] - WALL_M, x[0]],
                    "y_m": [-DOOR_M / 2, DOOR_M / 2],
                    "floor": _surface(rng, "boards"),
                }
            )
        west = x[1] + WALL_M
    first = areas[0]["x_m"]
    world = {
        "format": "topnav-world/1",
        "name": f"random {seed}",
        "start": {"x_m": (first[0] + first[1]) / 2, "y_m": 0.0, "yaw_deg": float(rng.uniform(-180, 180))},
        "openings": openings,
        "furniture": furniture,
    }
    if outdoor:
        return {
            **world,
            "environment": "outdoor",
            "grounds": areas,
            "sun": {"azimuth_deg": 40.0, "elevation_deg": 50.0},
        }
    return {**world, "rooms": areas}


def _area(
    rng: np.random.Generator, name: str, x: tuple[float, float], y: tuple[float, float], outdoor: bool
) -> dict[str, Any]:
    area: dict[str, Any] = {"name": name, "x_m": list(x), "y_m": list(y)}
    if outdoor:
        border = str(rng.choice(["fence", "wall", "barrier", "sidewalk"]))
        return {**area, "floor": _surface(rng, "tiles"), "border": border}
    return {**area, "floor": _surface(rng, "boards"), "walls": _surface(rng, "plaster"),
            "ceiling": _surface(rng, "ceiling")}  # fmt: skip


def _surface(rng: np.random.Generator, texture: str) -> dict[str, Any]:
    return {"texture": texture, "colour": rng.integers(90, 240, 3).tolist(), "seed": int(rng.integers(1000))}


def _furnished(
    rng: np.random.Generator, x: tuple[float, float], y: tuple[float, float], outdoor: bool
) -> list[dict[str, Any]]:
    """Pieces along the north and south sides; the way along y = 0 stays free."""
    items: list[dict[str, Any]] = []
    for side in (-1, 1):
        edge = y[0] if side < 0 else y[1]
        piece = str(rng.choice(FLOOR_PIECES))
        at = [float(rng.uniform(x[0] + 1.0, x[1] - 1.0)), edge - side * 0.5]
        items.append({"kind": piece, "at_m": at, "yaw_deg": -90.0 * side, "seed": int(rng.integers(1000))})
        if not outdoor:
            at = [float(rng.uniform(x[0] + 1.0, x[1] - 1.0)), edge]
            kind = str(rng.choice(WALL_PIECES))
            height = 0.0 if kind in ("door", "radiator") else 1.6
            items.append(
                {
                    "kind": kind,
                    "at_m": at,
                    "z_m": height,
                    "yaw_deg": -90.0 * side,
                    "seed": int(rng.integers(99)),
                }
            )
    size = rng.uniform(0.3, 0.8, 3).round(2).tolist()
    spot = [float(rng.uniform(x[0] + 0.8, x[1] - 0.8)), y[1] - 0.5]
    items.append({"kind": "mesh", "at_m": spot, "yaw_deg": float(rng.uniform(0, 90)),
                  "options": {"file": "crate.obj", "size_m": size}})  # fmt: skip
    if not outdoor:
        items.append({"kind": "ceiling_light", "at_m": [(x[0] + x[1]) / 2, 0.0], "z_m": 2.6})
    return items
