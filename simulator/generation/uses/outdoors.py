"""What stands on ground under the open sky, by what it is used for."""

from simulator.generation.palettes import CLOTHS, WALLS, Palette
from simulator.generation.placing import Furnisher

HOUSE_EVERY_M = 12.5
"""Chosen: a house is 9 m wide, and one can pass between two."""


def street(room: Furnisher, palette: Palette) -> None:
    """Lamps, a stop, cars at the kerb."""
    r = room.rect
    for k in range(int(r.size_m[0] // 9.0)):
        y, yaw_deg = (r.y1 - 0.5, -90.0) if k % 2 == 0 else (r.y0 + 0.5, 90.0)
        room.at("street_light", (r.x0 + 4.0 + 9.0 * k, y), yaw_deg)
    for _ in range(1 + int(r.size_m[0] // 15.0)):
        room.in_the_open("car", {"colour": palette.cloth()}, yaws=(0.0, 180.0))
    for kind in ("litter_bin", "mailbox", "park_bench"):
        room.in_the_open(kind)


def garden_south(room: Furnisher, _: Palette) -> None:
    """A row of houses that look south on the street."""
    _garden(room, -90.0)


def garden_north(room: Furnisher, _: Palette) -> None:
    """A row of houses that look north."""
    _garden(room, 90.0)


def yard(room: Furnisher, palette: Palette) -> None:
    """Containers, a truck, pallets, what else a works leaves outside."""
    area_m2 = room.rect.area_m2
    for _ in range(1 + int(area_m2 // 130.0)):
        room.in_the_open("container", {"colour": palette.cloth()})
    if area_m2 > 250.0:
        room.in_the_open("truck")
    some = ("pallet_stack", "drums", "pallet_pile", "forklift", "car", "bollard", "litter_bin", "flower_bed")
    for k in range(4 + int(area_m2 // 25.0)):
        room.in_the_open(some[k % len(some)], {})


def _garden(room: Furnisher, yaw_deg: float) -> None:
    """Houses in a row, each with other colours; trees, hedges and flowers between them."""
    r = room.rect
    count = int(r.size_m[0] // HOUSE_EVERY_M)
    x0 = r.centre_m[0] - HOUSE_EVERY_M * (count - 1) / 2
    for k in range(count):
        walls, shutters = (some[int(room.rng.integers(len(some)))] for some in (WALLS, CLOTHS))
        options = {"walls": list(walls), "shutters": list(shutters)}
        room.stand("house", (round(x0 + HOUSE_EVERY_M * k, 2), r.centre_m[1]), yaw_deg, options)
    for kind in ("tree", "flower_bed", "hedge", "tree", "park_bench", "flower_bed", "tree", "hedge"):
        room.in_the_open(kind, {"length_m": 2.4} if kind == "hedge" else None)
