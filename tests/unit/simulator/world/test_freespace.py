"""Free floor: what fits where, shortest ways, lines of sight, random poses."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from simulator.scene.parts import Material
from simulator.scene.prisms import Prism
from simulator.scene.shapes import hull_part
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile, load_world


@pytest.fixture(scope="module")
def plain(room):
    return free_space(room, robot_radius_m=0.25)


@pytest.fixture(scope="module")
def apartment():
    return free_space(load_world("apartment"), robot_radius_m=0.26)


@pytest.mark.parametrize(
    ("point", "free"),
    [
        ((1.0, 1.0), True),
        ((0.2, 2.0), False),
        ((0.35, 2.0), True),
        ((5.0, 3.0), False),
        ((4.3, 3.0), False),
        ((4.2, 3.0), True),
        ((-3.0, 2.0), False),
    ],
)
def test_robot_fits_only_a_radius_away_from_everything(plain, point, free):
    assert plain.is_free(point) == free


def test_straight_way_has_the_straight_length(plain):
    assert plain.shortest_path_m((1.0, 1.0), (5.0, 1.5)) == pytest.approx(math.hypot(4.0, 0.5), rel=0.005)


def test_way_round_the_table_is_longer_than_the_line_and_stays_free(plain):
    start, goal = (5.6, 2.0), (3.8, 3.7)
    path = plain.shortest_path(start, goal)
    assert plain.shortest_path_m(start, goal) > math.dist(start, goal)
    for a, b in pairwise(path):
        for t in np.linspace(0.0, 1.0, 20):
            cell = plain.cell((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
            assert plain.clearance_m[cell] >= plain.robot_radius_m - plain.resolution_m


def test_way_between_rooms_goes_through_the_opening(apartment):
    length = apartment.shortest_path_m((6.0, 1.2), (6.0, -0.9))
    assert 8.0 < length < 10.5


def test_wall_hides_and_table_does_not(plain, apartment):
    assert plain.line_of_sight((4.2, 3.0), (5.8, 3.6))
    assert not apartment.line_of_sight((6.0, 1.2), (6.0, -0.9))
    assert apartment.line_of_sight((1.7, 1.5), (1.6, -0.9))


def test_low_partition_is_looked_over_and_a_high_one_is_not(room_data):
    def between(high_m):
        item = {"kind": "partition", "at_m": [3.0, 2.0], "options": {"low_m": 0.6, "high_m": high_m}}
        return free_space(WorldFile.model_validate({**room_data, "furniture": [item]}))

    ends = (2.0, 2.0), (4.0, 2.0)
    assert not between(1.0).line_of_sight(*ends)
    assert between(1.0).in_view(*ends)
    assert not between(1.6).in_view(*ends)


def test_line_passes_beside_a_slanted_sheet_through_the_box_round_it(plain):
    corners = np.array([(2.0, 1.0), (2.1, 1.0), (4.1, 3.0), (4.0, 3.0)])
    sheet = hull_part(Prism(0.0, 2.0, corners), Material("plaster"))
    space = replace(plain, parts=(sheet,))
    assert space.line_of_sight((1.0, 1.5), (2.4, 2.9))
    assert not space.line_of_sight((2.4, 2.9), (3.6, 1.2))
    assert not space.line_of_sight((2.9, 1.0), (2.9, 3.0))


def test_random_poses_are_free_repeatable_and_spread(apartment):
    poses = [apartment.random_pose(np.random.default_rng(k), margin_m=0.1) for k in range(60)]
    assert all(apartment.is_free(p[:2]) for p in poses)
    assert poses[3] == apartment.random_pose(np.random.default_rng(3), margin_m=0.1)
    assert np.ptp([p[0] for p in poses]) > 6.0
    assert np.ptp([p[1] for p in poses]) > 6.0


def test_apartment_has_about_sixty_square_metres_and_is_all_connected(apartment):
    world = load_world("apartment")
    area = sum((r.x_m[1] - r.x_m[0]) * (r.y_m[1] - r.y_m[0]) for r in world.rooms)
    assert area == pytest.approx(61.5, abs=2.0)
    loose = (apartment.clearance_m >= 0.26) & ~apartment.free
    assert loose.sum() * apartment.resolution_m**2 < 0.05


def test_blocked_start_is_reported(room_data):
    world = WorldFile.model_validate({**room_data, "start": {"x_m": 5.0, "y_m": 3.0}})
    with pytest.raises(ValueError, match="start is not on free floor"):
        free_space(world)
