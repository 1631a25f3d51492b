"""Rooms of schools and offices, and what all public buildings have."""

from simulator.generation.palettes import Palette
from simulator.generation.placing import Furnisher
from simulator.generation.uses.arrangements import (
    clutter,
    desk_with_chair,
    pictures,
    rows_of_desks,
    table_with_chairs,
    window,
)


def corridor(room: Furnisher, palette: Palette) -> None:
    """Nothing that stands in the way, and what hangs on the walls of public buildings."""
    count = max(2, round(room.rect.size_m[0] / 2.5))
    for kind, z_m in (
        ("fire_extinguisher", 0.75),
        ("notice_board", 1.5),
        ("thermostat", 1.4),
        ("clock", 1.9),
    ):
        room.on_wall(kind, z_m)
    pictures(room, count)
    if room.rect.size_m[1] > 1.9:
        room.against_wall("radiator")
    clutter(room, palette, 1)


def lobby(room: Furnisher, palette: Palette) -> None:
    """Where one comes in."""
    room.against_wall("sofa", {"colour": palette.cloth(), "width_m": 1.6, "seats": 2}, centred=True)
    room.against_wall("vending_machine")
    room.on_wall("leaflet_rack", 0.5)
    room.on_wall("notice_board", 1.5)
    pictures(room, 4)
    clutter(room, palette, 3)


def classroom(room: Furnisher, palette: Palette) -> None:
    """Rows of desks before a board."""
    room.on_wall("whiteboard", 1.5, {"width_m": 2.4})
    room.against_wall("bookshelf", {"width_m": 1.6, "height_m": 1.6, "colour": palette.wood})
    rows_of_desks(room, palette, columns_m=1.35, rows_m=1.6)
    window(room, palette)
    window(room, palette)
    pictures(room, 4)
    clutter(room, palette, 1)


def office(room: Furnisher, palette: Palette) -> None:
    """Two desks and what is needed beside them."""
    for _ in range(2):
        desk_with_chair(room, palette, "office_chair", {})
    room.against_wall("bookshelf", {"width_m": 1.2, "colour": palette.wood})
    room.on_wall("whiteboard", 1.5, {"width_m": 1.4})
    window(room, palette)
    pictures(room, 2)
    clutter(room, palette, 2)


def meeting(room: Furnisher, palette: Palette) -> None:
    """A table with chairs round it, and a board."""
    table_with_chairs(room, palette, "meeting_table", 6)
    room.on_wall("whiteboard", 1.5)
    room.on_wall("clock", 1.9)
    window(room, palette)
    pictures(room, 2)
    clutter(room, palette, 1)
