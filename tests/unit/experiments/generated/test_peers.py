"""How far the peers drive that exploration is compared with."""

import math

import pytest

from experiments.generated.peers import frontier_curve, walk_curve
from services.launcher.evaluation.coverage_curve import metres_to
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile, load_world

LOOK = {part: {"texture": "plaster", "colour": [200, 200, 200]} for part in ("floor", "walls", "ceiling")}


def corridor(length_m, start_x_m=0.5):
    """2 m wide, with the start at its west end."""
    room = {"name": "corridor", "x_m": [0, length_m], "y_m": [0, 2], **LOOK}
    contents = {"format": "topnav-world/1", "name": "corridor", "rooms": [room]}
    world = WorldFile.model_validate({**contents, "start": {"x_m": start_x_m, "y_m": 1.0}})
    return free_space(world), (start_x_m, 1.0)


def frontier_m(space, start, *, covered_m, sight_m, share):
    return metres_to(frontier_curve(space, start, covered_m, sight_m, share), share)


def walk_m(space, start, *, covered_m, share, seed):
    return metres_to(walk_curve(space, start, covered_m, share, seed), share)


def test_a_corridor_is_driven_along_once():
    space, start = corridor(20.0)
    driven_m = frontier_m(space, start, covered_m=1.5, sight_m=4.0, share=0.97)
    assert driven_m == pytest.approx(20.0 - 0.5 - 1.5 - 0.03 * 20.0, abs=2.5)


def test_a_room_within_reach_costs_nothing():
    space, start = corridor(2.0, start_x_m=1.0)
    assert frontier_m(space, start, covered_m=2.0, sight_m=4.0, share=0.97) == 0.0
    assert walk_m(space, start, covered_m=2.0, share=0.97, seed=1) == 0.0


def test_a_walk_at_random_takes_longer_and_is_the_same_for_its_seed():
    space, start = corridor(20.0)
    walks = [walk_m(space, start, covered_m=1.5, share=0.97, seed=seed) for seed in (1, 1, 2)]
    assert walks[0] == walks[1] != walks[2]
    assert min(walks) > frontier_m(space, start, covered_m=1.5, sight_m=4.0, share=0.97)


def test_a_robot_that_sees_further_goes_round_furniture_to_what_is_behind_it():
    world = load_world("apartment")
    space = free_space(world)
    driven_m = frontier_m(space, (world.start.x_m, world.start.y_m), covered_m=1.0, sight_m=4.0, share=0.97)
    assert driven_m is not None
    assert driven_m > math.sqrt(space.free.sum() * space.resolution_m**2)


def test_a_curve_rises_to_the_share_wished_for_and_ends_there():
    space, start = corridor(20.0)
    for curve in (frontier_curve(space, start, 1.5, 4.0, 0.97), walk_curve(space, start, 1.5, 0.97, seed=1)):
        metres, shares = zip(*curve, strict=True)
        assert list(metres) == sorted(metres)
        assert list(shares) == sorted(shares)
        assert shares[-2] < 0.97 <= shares[-1]
