"""The office: one connected floor; islands, meeting rooms and bays repeat exactly."""

import math

import pytest

from simulator.world.contents import placed
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile, load_world


@pytest.fixture(scope="module")
def office() -> WorldFile:
    return load_world("office")


def pieces(world, name, origin_m):
    """Kinds, seeds, options and poses of what was placed under a name, relative to an origin."""
    items = [item for item in world.furniture if (item.name or "").startswith(f"{name} ")]
    places = [tuple(round(item.at_m[k] - origin_m[k], 6) for k in (0, 1)) for item in items]
    return [
        (item.kind, item.seed, item.options, place, item.yaw_deg, item.z_m)
        for item, place in zip(items, places, strict=True)
    ]


def test_the_open_plan_the_meeting_rooms_and_the_kitchen_are_one_floor(office):
    space = free_space(office)
    assert len(space.centres_m()) * space.resolution_m**2 > 120.0
    for place in (
        (5.7, 9.6),
        (1.05, 12.0),
        (15.3, 13.8),
        (17.0, 4.9),
        (17.0, 8.5),
        (17.0, 12.1),
        (17.2, 1.2),
    ):
        assert space.is_free(place), place
        assert math.isfinite(space.shortest_path_m((office.start.x_m, office.start.y_m), place))


def test_islands_differ_in_one_chair(office):
    origins = [(3.3 + 4.8 * k, 3.3 + 4.2 * row) for row in range(3) for k in range(3)]
    islands = [pieces(office, f"island {k + 1}", origin) for k, origin in enumerate(origins)]
    assert len(islands[0]) == 8
    odd = islands.pop(4)
    assert all(island == islands[0] for island in islands)
    assert sum(a != b for a, b in zip(odd, islands[0], strict=True)) == 1


def test_the_grain_of_equal_desks_is_the_same(office):
    desks = [
        placed(item, office.alike) for item in office.furniture if item.kind == "desk" and item.seed == 1
    ]
    assert len(desks) == 9
    assert len({tuple(part.texture_at_m for part in desk.parts) for desk in desks}) == 1


def test_islands_and_meeting_rooms_stand_on_the_same_tiles(office):
    tiles = {room.floor.tile_m for room in office.rooms if room.name != "kitchen"}
    assert tiles == {0.6}
    assert all(round(period / 0.6, 9).is_integer() for period in (4.8, 4.2, 3.6))
    rooms = [pieces(office, f"meeting room {k + 1}", (16.2, 3.8 + 3.6 * k)) for k in range(3)]
    assert rooms[0] == rooms[1] == rooms[2] != []
