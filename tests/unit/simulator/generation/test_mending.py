"""What stands in the way is taken away; what is no furniture's fault is said."""

import pytest

from simulator.generation.mending import GenerationError, mended
from simulator.generation.pieces import piece_at
from simulator.generation.world_text import furnished
from simulator.world.world_file import WorldFile

PAINT = {"texture": "lacquer", "colour": [200, 200, 200]}
LAMP = piece_at("ceiling_light", (1.0, 1.0), 0.0, 0, None, 2.6)


def two_rooms(door_m=1.2):
    """The doorway is in the middle of the wall between them."""
    surfaces = {"floor": PAINT, "walls": PAINT, "ceiling": PAINT}
    rooms = [
        {"name": "west", "x_m": [0.0, 4.0], "y_m": [0.0, 4.0], **surfaces},
        {"name": "east", "x_m": [4.15, 8.0], "y_m": [0.0, 4.0], **surfaces},
    ]
    opening = {"x_m": [4.0, 4.15], "y_m": [2.0 - door_m / 2, 2.0 + door_m / 2], "floor": PAINT}
    world = {"format": "topnav-world/1", "name": "two", "start": {"x_m": 1.0, "y_m": 1.0}, "rooms": rooms}
    return lambda pieces: WorldFile.model_validate(furnished({**world, "openings": [opening]}, pieces))


def test_only_what_stands_in_the_way_is_taken_away():
    blocks, beside = (piece_at("sideboard", at_m, 180.0, 0, None) for at_m in ((4.0, 2.0), (8.0, 2.0)))
    assert mended([LAMP, blocks, beside], two_rooms()) == [LAMP, beside]


def test_a_gap_too_tight_to_drive_through_is_widened():
    shelf = {"width_m": 1.72}
    pair = [piece_at("bookshelf", at_m, 0.0, 0, shelf) for at_m in ((6.0, 0.86), (6.0, 3.14))]
    left = mended([LAMP, *pair], two_rooms())
    assert LAMP in left
    assert len(left) == 2


def test_a_doorway_too_narrow_is_no_furnitures_fault():
    with pytest.raises(GenerationError, match=r"two: floor near .* cannot be reached whatever is taken away"):
        mended([LAMP], two_rooms(door_m=0.4))
