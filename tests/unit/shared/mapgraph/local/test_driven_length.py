"""A new node is so far from a neighbour as the robot drove."""

import math

import pytest

from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.driven_length import driven_length
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(6, 1)
HERE = Displacement(3, x_m=0.5, y_m=0.3, spread_m=0.1)


def length(neighbours, here=HERE):
    return driven_length(GRAPH, here, neighbours, 200)


def test_it_is_the_way_from_the_node_it_came_from():
    known = length({1, 3, 4})
    assert (known.node_id, known.length_m, known.std_m) == (3, pytest.approx(math.hypot(0.5, 0.3)), 0.1)


def test_without_an_edge_to_that_node_it_is_the_way_from_the_next_one():
    known = length({0, 2})
    assert (known.node_id, known.length_m) == (2, pytest.approx(math.hypot(1.5, 0.3), abs=0.05))
    assert known.std_m > 0.15, "what joins the two is uncertain too"


def test_of_what_no_edge_joins_nothing_is_known():
    assert length(set()) is None
    assert length({2}, Displacement(99)) is None
