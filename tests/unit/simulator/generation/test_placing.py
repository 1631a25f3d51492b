"""Furniture leaves ways that the robot can go, or no gap at all."""

from itertools import combinations

import numpy as np
import pytest

from simulator.generation.placing import NICHE_M, WAY_M, Furnisher
from simulator.generation.plans.rectangles import Rect

ROOM = Rect(0.0, 0.0, 4.0, 5.0)
DOOR = Rect(1.5, -0.15, 2.6, 0.0)
WAY = Rect(1.45, -1.1, 2.65, 0.95)


def furnisher(seed=1, room=ROOM, outside=frozenset({0.0})):
    return Furnisher(room, [WAY], [DOOR], outside, np.random.default_rng(seed))


@pytest.mark.parametrize("seed", range(20))
def test_between_things_is_a_way_or_no_gap(seed):
    room = furnisher(seed)
    for kind in ("bed", "wardrobe", "desk", "bookshelf", "sideboard", "bedside_table"):
        room.against_wall(kind)
    gaps = [a.box.gap_m(b.box) for a, b in combinations(room.placed, 2)]
    assert len(room.placed) >= 3
    assert all(0.0 <= gap <= NICHE_M or gap >= WAY_M for gap in gaps)
    assert all(piece.box.gap_m(WAY) >= 0.0 for piece in room.placed)
    assert all(ROOM.grown(0.05).holds(piece.box) for piece in room.placed)


def test_what_stands_in_the_open_can_be_gone_round():
    table = furnisher().in_the_open("round_table")
    inside = ROOM.grown(-WAY_M)
    assert inside.holds(table.box)


def test_where_nothing_fits_it_is_left_out():
    small = furnisher(room=Rect(0.0, 0.0, 1.5, 1.2))
    assert small.in_the_open("dining_table") is None
    assert small.against_wall("bed") is None
    assert small.placed == []


@pytest.mark.parametrize("seed", range(10))
def test_windows_are_in_outer_walls_and_nothing_hangs_in_a_doorway(seed):
    room = furnisher(seed)
    window = room.on_wall("window", 0.9, daylight=True)
    assert window.yaw_deg == 0.0
    pictures = [room.on_wall("picture", 1.5) for _ in range(8)]
    hung = [piece for piece in pictures if piece is not None]
    assert hung
    assert all(piece.box.gap_m(DOOR) > 0.0 for piece in hung)


def test_a_picture_does_not_hang_behind_a_wardrobe():
    room = furnisher(room=Rect(0.0, 1.0, 2.6, 3.6))
    wardrobe = room.against_wall("wardrobe")
    hung = [room.on_wall("picture", 1.2) for _ in range(12)]
    assert all(piece is None or piece.box.gap_m(wardrobe.box) >= 0.0 for piece in hung)
