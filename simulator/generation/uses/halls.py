"""Halls: open-plan offices, stores, warehouses, shops."""

from simulator.generation.palettes import Palette
from simulator.generation.placing import ROW_SEED, Furnisher
from simulator.generation.uses.arrangements import (
    clutter,
    desk_island,
    grid,
    pictures,
    table_with_chairs,
    window,
)


def open_office(room: Furnisher, palette: Palette) -> None:
    """Desk islands in rows, all alike."""
    for kind in ("copier", "lockers", "bookshelf", "water_cooler"):
        room.against_wall(kind, centred=kind == "water_cooler")
    for x, y in grid(room, 3.6, 3.4):
        desk_island(room, palette, x, y)
    for _ in range(3):
        window(room, palette)
    pictures(room, 6)
    clutter(room, palette, 4)


def storage(room: Furnisher, palette: Palette) -> None:
    """A small room for what is not needed now."""
    room.against_wall("lockers", {"colour": palette.cloth()})
    room.against_wall("bookshelf", {"width_m": 1.2, "colour": palette.wood})
    room.against_wall("pallet_pile", centred=True)
    room.on_wall("fuse_box", 1.5)
    pictures(room, 1)


def warehouse(room: Furnisher, palette: Palette) -> None:
    """Racks in rows, pallets, a forklift."""
    room.against_wall("workbench")
    room.against_wall("lockers", {"colour": palette.cloth()})
    for x, y in grid(room, 7.0, 3.6):
        room.stand("pallet_rack", (x, y), 90.0)
    for kind in ("forklift", "pallet_stack", "pallet_stack", "drums", "pallet_pile", "pallet_stack"):
        room.in_the_open(kind)
    for kind, z_m in (("fire_extinguisher", 0.75), ("fuse_box", 1.5), ("clock", 2.2), ("notice_board", 1.5)):
        room.on_wall(kind, z_m)
    pictures(room, 3)


def shop(room: Furnisher, palette: Palette) -> None:
    """Shelves back to back in rows, a till."""
    room.against_wall("reception_desk", {"colour": palette.wood}, centred=True)
    for kind in ("fridge", "vending_machine", "recycling_bins"):
        room.against_wall(kind, centred=kind == "recycling_bins")
    for x, y in grid(room, 3.6, 2.2):
        shelf = {"width_m": 2.4, "height_m": 1.6, "colour": palette.wood}
        if room.stand("bookshelf", (x, y), 90.0, shelf, both=True):
            room.at("bookshelf", (x, y), -90.0, shelf, seed=ROW_SEED)
    table_with_chairs(room, palette, "round_table", 0)
    window(room, palette)
    pictures(room, 6)
    clutter(room, palette, 3)
