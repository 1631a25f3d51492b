"""Much floor early on short ways: the next frontier is the first of the best order of all."""

from functools import partial
from itertools import permutations

import numpy as np
import pytest

from services.planner.mapping.frontiers.visiting_order import first_of, first_to_visit
from shared.mapgraph.routing import open_ways, way_m
from shared.mapgraph.rules import NO_LIMITS, Limits
from shared.messages.maps import Node
from tests.unit.shared.mapgraph.local.grid import grid

START = 4
"""The middle of nine nodes in a row, a metre apart."""


def first(gains, start=START, graph=None, banned=(), limits=NO_LIMITS):
    graph = grid(9, 1) if graph is None else graph
    return first_to_visit(open_ways(graph, partial(way_m, graph), banned, limits), start, gains)


@pytest.mark.parametrize(
    ("gains", "expected"),
    [
        ({3: 1.0, 7: 1.0}, 3),
        ({3: 0.1, 7: 1.0}, 7),
        ({5: 0.1, 7: 1.0}, 5),
        ({2: 1.0, 6: 0.7, 7: 0.7, 8: 0.7}, 6),
        ({START: 0.1, 7: 1.0}, START),
        ({7: 0.5}, 7),
        ({}, None),
    ],
    ids=[
        "the nearest of equal ones",
        "much floor before the nearest",
        "little floor that lies on the way",
        "a group before one that is as near",
        "here",
        "the only one",
        "none",
    ],
)
def test_the_next_frontier_is(gains, expected):
    assert first(gains) == expected


def test_frontiers_without_a_way_are_left_out_and_who_stands_apart_has_none():
    graph = grid(9, 1)
    graph.nodes[20] = Node(node_id=20)
    assert first({20: 9.0, 7: 0.1}, graph=graph) == 7
    assert first({20: 9.0}, graph=graph) is None
    assert first({7: 1.0}, start=20, graph=graph) is None
    assert first({20: 1.0, 7: 1.0}, start=20, graph=graph) == 20


@pytest.mark.parametrize(
    ("forbidden", "expected"),
    [
        ({"limits": Limits(forbidden={3: "shut"})}, 7),
        ({"limits": Limits(closed={(3, 2): "down"})}, 7),
        ({"limits": Limits(closed={(2, 3): "up"})}, 7),
        ({"limits": Limits(slow={(4, 3): 0.1, (3, 4): 0.1})}, 7),
        ({"banned": {(2, 3)}}, 7),
        ({}, 2),
    ],
    ids=["a keep-out", "one way", "no way back", "a slow way", "an edge that failed", "nothing"],
)
def test_what_is_in_the_way_of_the_nearer_frontier_counts(forbidden, expected):
    assert first({2: 0.9, 7: 1.0}, **forbidden) == expected


def test_the_first_of_the_best_of_all_orders_is_found():
    """Of 720 orders of six places on a plane; a search by single moves may stop before the best."""
    orders = np.array([[0, *order] for order in permutations(range(1, 7))])
    rng, right = np.random.default_rng(1), 0
    for _ in range(100):
        spots_m, gains = rng.uniform(0.0, 10.0, (7, 2)), rng.uniform(0.1, 1.0, 6)
        apart_m = np.linalg.norm(spots_m[:, None] - spots_m[None], axis=2)
        driven_m = np.cumsum(apart_m[orders[:, :-1], orders[:, 1:]], axis=1)
        best = (gains[orders[:, 1:] - 1] * driven_m).sum(axis=1).argmin()
        right += first_of(apart_m, gains) == orders[best, 1] - 1
    assert right >= 96
