"""The factory: hall and yard are one floor, joined by the gate and by the side door."""

import math

import pytest

from simulator.scene.parts import solids_between
from simulator.world.freespace import free_space
from simulator.world.grounds import ground_parts
from simulator.world.world_file import WorldFile, load_world

HALL, YARD = (9.0, 7.0), (25.0, 7.0)


@pytest.fixture(scope="module")
def factory() -> WorldFile:
    return load_world("factory")


def test_the_robot_passes_the_gate_in_and_out(factory: WorldFile):
    space = free_space(factory)
    assert len(space.centres_m()) * space.resolution_m**2 > 350.0
    straight = math.dist(HALL, YARD)
    assert space.shortest_path_m(HALL, YARD) < 1.05 * straight
    assert space.shortest_path_m(YARD, HALL) < 1.05 * straight


def test_the_side_door_is_another_way(factory: WorldFile):
    space = free_space(factory)
    assert space.shortest_path_m((17.2, 12.7), (19.2, 12.7)) < 2.2


def test_no_border_stands_in_the_wall_of_the_hall(factory: WorldFile):
    walls = solids_between(ground_parts(factory), 0.05, 2.0)
    beside_hall = [p for p in walls if abs(p.centre_m[0] - 18.13) < 0.2]
    assert all(p.centre_m[1] - p.size_m[1] / 2 >= 14.0 for p in beside_hall)
    assert beside_hall, "north of the hall the yard needs its wall"
