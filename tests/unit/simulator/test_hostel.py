"""The hostel: every room can be entered, and twins differ in nothing but the way there."""

import math
from dataclasses import replace

import numpy as np
import pytest

from simulator.world.contents import expand
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import WorldFile, load_world

TWINS = (("room 2", "room 4"), ("room 6", "room 9"))
OTHERS = ("room 1", "room 3", "room 5", "room 7", "room 8", "room 10")
WALL_M = 0.1


@pytest.fixture(scope="module")
def hostel() -> WorldFile:
    return load_world("hostel")


@pytest.fixture(scope="module")
def space(hostel) -> FreeSpace:
    return free_space(hostel)


def room(world, name):
    return next(room for room in world.rooms if room.name == name)


def contents(world, name):
    """Parts with their middle in a room or its walls, and lamps in it, in the frame of its corner."""
    area = room(world, name)
    low = np.array([area.x_m[0], area.y_m[0], 0.0])

    def own(things):
        for thing in things:
            place = rounded(np.array(thing.centre_m) - low)
            size = (area.x_m[1] - area.x_m[0], area.y_m[1] - area.y_m[0])
            if all(-WALL_M < place[k] < size[k] + WALL_M for k in (0, 1)):
                yield replace(thing, centre_m=place, size_m=rounded(thing.size_m))

    parts, lights = expand(world)
    return list(own(parts)), list(own(lights))


def rounded(values):
    return tuple(round(float(value), 6) + 0.0 for value in values)


def test_every_room_has_floor_to_drive_on_and_a_way_to_it(hostel, space):
    reached = space.centres_m()
    for name in (*(name for pair in TWINS for name in pair), *OTHERS):
        area = room(hostel, name)
        low, high = (area.x_m[0], area.y_m[0]), (area.x_m[1], area.y_m[1])
        inside = ((reached > low) & (reached < high)).all(axis=1)
        assert inside.sum() * space.resolution_m**2 > 4.5, name


def test_the_corridor_joins_lobby_rooms_and_the_seat_at_its_end(hostel, space):
    start = (hostel.start.x_m, hostel.start.y_m)
    for place in ((18.1, 1.0), (1.8, 4.2), (5.4, 3.6), (12.6, 3.6), (1.9, -1.6), (12.7, -1.6), (16.2, -1.6)):
        assert space.is_free(place), place
        assert math.isfinite(space.shortest_path_m(start, place))


@pytest.mark.parametrize(("one", "other"), TWINS)
def test_twins_are_built_of_the_same_parts_and_lamps(hostel, one, other):
    ours, theirs = contents(hostel, one), contents(hostel, other)
    assert len(ours[0]) > 100
    assert len(ours[1]) == 3
    assert ours == theirs


@pytest.mark.parametrize(("one", "other"), TWINS)
def test_textures_of_large_surfaces_repeat_from_twin_to_twin(hostel, one, other):
    a, b = room(hostel, one), room(hostel, other)
    apart = b.x_m[0] - a.x_m[0]
    assert a.y_m == b.y_m
    for surface in (a.floor, a.walls, a.ceiling):
        assert round(apart / surface.tile_m, 9).is_integer()


def test_all_other_rooms_differ_from_the_twins_on_their_side(hostel):
    for name in OTHERS:
        twin = "room 2" if name in OTHERS[:3] else "room 6"
        assert contents(hostel, name) != contents(hostel, twin), name
