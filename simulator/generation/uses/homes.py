"""Rooms of flats, hostels and hotels."""

from simulator.generation.palettes import Palette
from simulator.generation.placing import Furnisher
from simulator.generation.uses.arrangements import (
    before,
    clutter,
    desk_with_chair,
    pictures,
    rug,
    table_with_chairs,
    window,
)


def bedroom(room: Furnisher, palette: Palette) -> None:
    """A bed with its table, a wardrobe, a desk."""
    bed = room.against_wall("bed", {"blanket": palette.cloth(), "colour": palette.wood})
    if bed is not None:
        room.against_wall("bedside_table", {"colour": palette.wood})
    room.against_wall("wardrobe", {"colour": palette.wood})
    desk_with_chair(room, palette, "chair", {"width_m": 1.1, "depth_m": 0.55, "screens": 0})
    rug(room, palette, 1.5, 1.0)
    window(room, palette)
    pictures(room, 3)
    clutter(room, palette, 2)


def living(room: Furnisher, palette: Palette) -> None:
    """A sofa with its table before a television, shelves, a table to eat at."""
    sofa = room.against_wall("sofa", {"colour": palette.cloth()}, front_m=0.75, centred=True)
    if sofa is not None:
        room.at("coffee_table", before(sofa, 0.78), sofa.yaw_deg, {"colour": palette.wood})
        room.at("rug", before(sofa, 0.78), sofa.yaw_deg, {"colour": palette.cloth()})
    bench = room.against_wall("tv_bench", {"colour": palette.wood})
    if bench is not None:
        room.at("television", before(bench, 0.12), bench.yaw_deg, z_m=0.56)
    room.against_wall("bookshelf", {"colour": palette.wood})
    table_with_chairs(room, palette, "dining_table", 4)
    room.against_wall("sideboard", {"colour": palette.wood})
    room.against_wall("armchair", {"colour": palette.cloth()}, centred=True)
    window(room, palette)
    window(room, palette)
    pictures(room, 5)
    clutter(room, palette, 3)


def kitchen(room: Furnisher, palette: Palette) -> None:
    """A counter, a refrigerator, a table where it fits."""
    length_m = round(min(3.0, max(2.4, max(room.rect.size_m) - 1.2)), 1)
    room.against_wall("kitchen_counter", {"length_m": length_m, "colour": palette.cloth()})
    room.against_wall("fridge")
    table_with_chairs(room, palette, "round_table", 3)
    window(room, palette)
    room.on_wall("clock", 1.8)
    pictures(room, 2)
    clutter(room, palette, 1)


def study(room: Furnisher, palette: Palette) -> None:
    """A desk, and shelves."""
    desk_with_chair(room, palette, "office_chair", {})
    for width_m in (1.8, 1.2):
        room.against_wall("bookshelf", {"width_m": width_m, "colour": palette.wood})
    room.against_wall("sideboard", {"width_m": 1.0, "colour": palette.wood})
    window(room, palette)
    pictures(room, 3)
    clutter(room, palette, 2)


def hall(room: Furnisher, palette: Palette) -> None:
    """Where coats and shoes are left."""
    room.against_wall("shoe_cabinet", {"colour": palette.wood})
    room.against_wall("console_table", {"width_m": 0.8, "depth_m": 0.26, "colour": palette.wood})
    room.on_wall("coat_rack", 1.65, {"coats": 3})
    room.on_wall("mirror", 1.45)
    window(room, palette)
    pictures(room, 4)
    clutter(room, palette, 1)
