"""MapFeatures cover the free floor at their spacing; pictures are taken beside them."""

import math

import numpy as np
import pytest

from experiments.scale.frames import NEAR, node_poses, query_poses
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_file import load_world

SPACING_M = 0.6


@pytest.fixture(scope="module")
def space() -> FreeSpace:
    return free_space(load_world("apartment"))


def apart_m(one: Pose, other: Pose) -> float:
    return math.dist((one.x_m, one.y_m), (other.x_m, other.y_m))


def test_places_keep_their_distance_and_leave_no_gap(space):
    places = node_poses(space, SPACING_M, np.random.default_rng(1))
    assert min(apart_m(a, b) for k, a in enumerate(places) for b in places[:k]) >= SPACING_M
    for x_m, y_m in space.centres_m()[::17].tolist():
        assert min(math.dist((x_m, y_m), (place.x_m, place.y_m)) for place in places) < SPACING_M


def test_pictures_are_taken_in_free_sight_of_a_place_near_it(space):
    places = node_poses(space, SPACING_M, np.random.default_rng(1))
    queries = query_poses(space, places, SPACING_M, 30, np.random.default_rng(2))
    assert len(queries) == 30
    for query in queries:
        assert space.is_free((query.x_m, query.y_m))
        assert any(
            apart_m(query, place) <= NEAR[1] * SPACING_M
            and space.line_of_sight((query.x_m, query.y_m), (place.x_m, place.y_m))
            for place in places
        )


def test_the_same_seed_gives_the_same_poses(space):
    first, second = (node_poses(space, SPACING_M, np.random.default_rng(5)) for _ in range(2))
    assert first == second
