"""Graph of places: cheapest paths against brute force, headings from both ends, suspended edges."""

import itertools
import math

import numpy as np
import pytest

from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import fewest_nodes, least_disparity, plan_path
from shared.messages.maps import DeleteNode, Edge, Node, PutEdge


def graph(edges, count=8):
    made = [Edge(a=min(p), b=max(p), disparity_rad=0.1, clear=True) for p in edges]
    return MapGraph([Node(node_id=n) for n in range(count)], made)


def brute_force(edges, source, target, count):
    for length in range(1, count + 1):
        between = [n for n in range(count) if n not in (source, target)]
        for middle in itertools.permutations(between, length - 1):
            walk = (source, *middle, target)
            if all(frozenset(step) in edges for step in itertools.pairwise(walk)):
                return length + 1
    return 0


def test_fewest_nodes_equals_brute_force_on_random_graphs():
    rng = np.random.default_rng(1)
    for _ in range(20):
        pairs = {frozenset(map(int, rng.choice(6, 2, replace=False))) for _ in range(8)}
        path = plan_path(graph([tuple(p) for p in pairs], 6), {0: 0.0}, {5: 0.0}, fewest_nodes)
        assert len(path) == brute_force(pairs, 0, 5, 6)


def test_unseen_ground_is_avoided_when_there_is_another_way():
    nodes = [Node(node_id=n) for n in range(3)]
    direct = Edge(a=0, b=2, disparity_rad=0.1)
    around = [Edge(a=0, b=1, disparity_rad=0.1, clear=True), Edge(a=1, b=2, disparity_rad=0.1, traversals=1)]
    assert plan_path(MapGraph(nodes, [direct, *around]), {0: 0.0}, {2: 0.0}, least_disparity) == [0, 1, 2]
    assert plan_path(MapGraph(nodes, [direct, *around]), {0: 0.0}, {2: 0.0}, fewest_nodes) == [0, 2]


@pytest.mark.parametrize("cost", [fewest_nodes, least_disparity])
def test_suspended_edge_is_the_last_resort(cost):
    nodes = [Node(node_id=n) for n in range(8)]
    suspended = Edge(a=0, b=1, disparity_rad=0.1, clear=True, suspended=True)
    around = [Edge(a=min(p), b=max(p), disparity_rad=0.3) for p in itertools.pairwise([0, 2, 3, 4, 5, 6, 7])]
    around.append(Edge(a=1, b=7, disparity_rad=0.3))
    assert plan_path(MapGraph(nodes, [suspended]), {0: 0.0}, {1: 0.0}, cost) == [0, 1]
    assert plan_path(MapGraph(nodes, [suspended, *around]), {0: 0.0}, {1: 0.0}, cost) == [
        0,
        2,
        3,
        4,
        5,
        6,
        7,
        1,
    ]


def test_an_edge_of_infinite_cost_is_no_way():
    assert plan_path(graph([(0, 1)]), {0: 0.0}, {1: 0.0}, lambda _edge: math.inf) == []


def test_suspended_edges_join_no_components():
    places = MapGraph([Node(node_id=0), Node(node_id=1)], [Edge(a=0, b=1, suspended=True)])
    assert places.components() == 2


def test_deleting_a_node_takes_its_edges():
    places = graph([(0, 1), (1, 2), (2, 3)])
    places.apply([DeleteNode(node_id=1)])
    assert set(places.edges) == {(2, 3)}


@pytest.mark.parametrize(("first", "second"), [(0, 1), (1, 0)])
def test_headings_of_an_edge_agree_from_both_ends(first, second):
    """Robot at the origin looking along x, the other 1 m to its left and turned by 90 degrees to the left."""
    fields = edge_between(first, second, math.pi / 2, math.pi / 2)
    places = MapGraph([Node(node_id=0), Node(node_id=1)])
    places.apply([PutEdge(edge=Edge.model_validate(fields))])
    assert places.heading(first, second) == pytest.approx(math.pi / 2)
    assert abs(math.remainder(places.heading(second, first) - math.pi, math.tau)) < 1e-9
