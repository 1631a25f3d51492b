"""Bearings of known nodes cross where a frame was taken; distances decide where they do not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.resection import bearing_miss_rad, resected
from shared.messages.maps import Node
from tests.unit.shared.mapgraph.local.grid import at, claim, edge, grid

SQUARE, CORRIDOR = grid(5, 5), grid(12, 1)


def seen(columns, nodes, x_m, y_m):
    """Claims of nodes by a frame at this place of the grid."""
    return {n: claim(at(n, columns)[0] - x_m, at(n, columns)[1] - y_m) for n in nodes}


def place(graph, claims, root=0, reckoned=None):
    return resected(graph, claims, root, 60, reckoned)


def off_m(found, x_m, y_m):
    return math.dist((found.x_m, found.y_m), (x_m, y_m))


def test_bearings_cross_whatever_matches_say():
    claims = seen(5, (0, 1, 5, 6, 12), 1.4, 0.7)
    near = {n: replace(c, length_m=0.5 * c.length_m) for n, c in claims.items()}
    assert off_m(place(SQUARE, claims), 1.4, 0.7) < 0.02
    assert off_m(place(SQUARE, near), 1.4, 0.7) < 0.15


def test_bearings_that_cross_miss_no_node_and_parallel_ones_do():
    """As from far away: by their matches all are 2 m ahead."""
    claims, far = seen(5, (0, 1, 5, 6, 12), 1.4, 0.7), {n: claim(2.0, 0.0) for n in (0, 1, 5, 6)}
    assert bearing_miss_rad(SQUARE, claims, place(SQUARE, claims), 60) < math.radians(1.0)
    assert bearing_miss_rad(SQUARE, far, place(SQUARE, far), 60) > math.radians(9.0)


def test_nodes_at_the_very_spot_have_no_bearing_to_miss():
    claims = {6: claim(0.0, 0.0)}
    assert bearing_miss_rad(SQUARE, claims, place(SQUARE, claims, root=6), 60) is None


def test_along_a_corridor_nodes_before_and_behind_say_how_far_views_carry():
    """Here they carry further than around: distances by matches are two thirds of what they are."""
    claims = seen(12, (3, 4, 5, 6, 7), 4.7, 0.0)
    far = {n: replace(c, length_m=0.67 * c.length_m) for n, c in claims.items()}
    found = place(CORRIDOR, far, root=5)
    assert off_m(found, -0.3, 0.0) < 0.1
    crossing = place(SQUARE, seen(5, (0, 1, 5, 6, 12), 1.4, 0.7))
    assert found.spread_m > 1.5 * crossing.spread_m, "less sure than where bearings cross"


def test_bearings_that_cross_beyond_what_is_ahead_say_nothing():
    """A street: two nodes far ahead, one a few degrees off; their lines cross between the nodes."""
    ahead = {5: claim(9.0, -0.36), 7: replace(claim(9.0, 0.0), heading_rad=0.19)}
    assert place(CORRIDOR, ahead, root=5) is None
    assert place(CORRIDOR, seen(12, (5, 7), 1.0, 0.0), root=5) is not None


def test_a_robot_that_has_not_moved_yet_is_where_it_was():
    claims = {0: replace(claim(1.0, 0.0), heading_rad=None, length_m=0.0)}
    found = place(SQUARE, claims, reckoned=Displacement(0))
    assert off_m(found, 0.0, 0.0) < 0.01
    assert found.spread_m < 0.1


def test_it_is_said_of_the_root_and_turned_with_its_camera():
    turned = edge(0, 1, 5).model_copy(update={"yaw_ab_rad": math.pi / 2, "heading_ba_rad": math.pi / 2})
    graph = MapGraph([Node(node_id=n) for n in range(2)], [turned])
    claims = {0: claim(-0.5, 0.3), 1: replace(claim(0.5, 0.3), yaw_rad=math.pi / 2)}
    of_0, of_1 = place(graph, claims, 0), place(graph, claims, 1)
    assert off_m(of_0, 0.5, -0.3) < 0.05
    assert off_m(of_1, -0.3, 0.5) < 0.05
    assert (of_0.yaw_rad, of_1.yaw_rad) == pytest.approx((0.0, -math.pi / 2), abs=1e-6)


def test_one_look_alike_among_true_sights_moves_nothing_far():
    claims = seen(5, (0, 1, 5, 6, 7), 1.4, 0.7) | {24: claim(0.2, 0.2)}
    assert off_m(place(SQUARE, claims), 1.4, 0.7) < 0.1


def test_what_was_driven_decides_where_little_is_seen():
    sight = {5: claim(1.0, 0.0)}
    reckoned = Displacement(3, x_m=0.6, spread_m=0.05)
    assert off_m(place(CORRIDOR, sight, root=5, reckoned=reckoned), -1.4, 0.0) < 0.1
    strayed = replace(reckoned, spread_m=3.0)
    assert off_m(place(CORRIDOR, sight, root=5, reckoned=strayed), -1.0, 0.0) < 0.05


def test_its_spread_is_what_it_misses_by():
    rng = np.random.default_rng(3)
    ratios = []
    for _ in range(60):
        x_m, y_m = rng.uniform(0.5, 3.5, 2)
        claims = {
            n: replace(
                c,
                heading_rad=None if c.heading_rad is None else c.heading_rad + rng.normal(0.0, 0.025),
                length_m=c.length_m * rng.lognormal(0.0, 0.35),
            )
            for n, c in seen(5, rng.choice(25, 4, replace=False).tolist(), x_m, y_m).items()
        }
        found = place(SQUARE, claims)
        ratios.append(off_m(found, x_m, y_m) / found.spread_m)
    assert 0.3 < np.percentile(ratios, 68) < 1.5


def test_nothing_known_is_no_place():
    assert place(SQUARE, {}) is None
    assert place(SQUARE, {0: claim(1.0, 0.0)}, root=99) is None
