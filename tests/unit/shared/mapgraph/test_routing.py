"""Graph of places: cheapest paths against brute force, headings from both ends, suspended edges."""

import itertools
import math
from functools import partial

import numpy as np
import pytest

from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import fewest_crossable, fewest_nodes, plan_path, way_m
from shared.messages.maps import DeleteNode, Edge, Node, PutEdge


def graph(edges, count=8):
    made = [Edge(a=min(p), b=max(p), inliers=80, clear=True) for p in edges]
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
    direct = Edge(a=0, b=2, inliers=80)
    around = [Edge(a=0, b=1, inliers=80, clear=True), Edge(a=1, b=2, inliers=80, traversals=1)]
    flat = MapGraph(nodes, [direct, *around])
    assert plan_path(flat, {0: 0.0}, {2: 0.0}, partial(way_m, flat)) == [0, 1, 2]
    assert plan_path(flat, {0: 0.0}, {2: 0.0}, fewest_nodes) == [0, 2]


def test_the_shorter_of_two_ways_is_taken_whatever_the_number_of_nodes():
    """Four short edges, or two long ones that few matches tell."""
    nodes = [Node(node_id=n) for n in range(5)]
    chain = [Edge(a=n, b=n + 1, inliers=200, length_m=0.5, clear=True) for n in range(3)]
    far = [Edge(a=0, b=4, inliers=25, clear=True), Edge(a=3, b=4, inliers=25, clear=True)]
    flat = MapGraph(nodes, [*chain, *far])
    assert plan_path(flat, {0: 0.0}, {3: 0.0}, partial(way_m, flat)) == [0, 1, 2, 3]
    assert plan_path(flat, {0: 0.0}, {3: 0.0}, fewest_nodes) == [0, 4, 3]


@pytest.mark.parametrize("by_length", [False, True])
def test_suspended_edge_is_the_last_resort(by_length):
    nodes = [Node(node_id=n) for n in range(8)]
    suspended = Edge(a=0, b=1, inliers=80, clear=True, suspended=True)
    around = [Edge(a=min(p), b=max(p), inliers=40) for p in itertools.pairwise([0, 2, 3, 4, 5, 6, 7])]
    around.append(Edge(a=1, b=7, inliers=40))
    for edges, way in (([suspended], [0, 1]), ([suspended, *around], [0, 2, 3, 4, 5, 6, 7, 1])):
        flat = MapGraph(nodes, edges)
        cost = partial(way_m, flat) if by_length else fewest_nodes
        assert plan_path(flat, {0: 0.0}, {1: 0.0}, cost) == way


@pytest.mark.parametrize("change", [{"raw_matches": 80}, {"clear": False}])
def test_an_edge_that_is_none_to_the_thesis_is_the_last_resort_but_for_suspended_ones(change):
    """Of too few matches, or over ground that nobody saw free."""
    nodes = [Node(node_id=n) for n in range(4)]
    way = [Edge(a=n, b=n + 1, raw_matches=81, inliers=20, clear=True) for n in range(3)]
    across = Edge(a=0, b=3, raw_matches=90, inliers=80, clear=True).model_copy(update=change)
    suspended = way[1].model_copy(update={"suspended": True})
    driven = across.model_copy(update={"raw_matches": 81, "traversals": 1})
    cost = partial(fewest_crossable, similarity_min=80)
    for edges, path in (
        ([across, *way], [0, 1, 2, 3]),
        ([across, way[0], suspended, way[2]], [0, 3]),
        ([across], [0, 3]),
        ([driven, *way], [0, 3]),
    ):
        assert plan_path(MapGraph(nodes, edges), {0: 0.0}, {3: 0.0}, cost) == path


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
