"""Frontiers: open and unexplored directions, marked by edges to near places and by departures."""

import math

import numpy as np

from services.planner.profiles import DEFAULT
from services.planner.surroundings import free_ways_m
from shared.mapgraph.frontiers import (
    ExploredRules,
    with_explored,
)
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node
from shared.messages.sensors import Ranges

ANGLES = tuple(i * math.tau / 12 for i in range(12))
ALL_OPEN = (True,) * 12


def test_opening_is_a_way_the_robot_fits_through():
    distances = np.full(12, 4.0)
    distances[3] = 0.5
    ranges = Ranges(robot="r1", angles_rad=ANGLES, distances_m=tuple(distances), max_range_m=4.0)
    free_m = free_ways_m(ranges, DEFAULT)
    assert free_m[3] < DEFAULT.sensing.opening_m
    assert free_m[0] == free_m[6] == 4.0


def test_edge_to_a_near_place_explores_its_direction_only():
    near = Edge(a=0, b=1, heading_ab_rad=math.pi / 2, heading_ba_rad=-math.pi / 2, inliers=50)
    nodes = [Node(node_id=0, open=ALL_OPEN), Node(node_id=1, open=ALL_OPEN)]
    node = with_explored(nodes[0], MapGraph(nodes, [near]), ExploredRules())
    assert [s for s in range(12) if node.explored[s]] == [3]


def test_edge_to_a_very_near_place_explores_the_directions_beside_it():
    near = Edge(a=0, b=1, heading_ab_rad=math.pi / 2, heading_ba_rad=-math.pi / 2, inliers=80)
    nodes = [Node(node_id=0, open=ALL_OPEN), Node(node_id=1, open=ALL_OPEN)]
    node = with_explored(nodes[0], MapGraph(nodes, [near]), ExploredRules())
    assert [s for s in range(12) if node.explored[s]] == [2, 3, 4]


def test_edge_to_a_far_place_leaves_the_ground_between_unexplored():
    far = Edge(a=0, b=1, heading_ab_rad=0.0, heading_ba_rad=math.pi, inliers=35)
    nodes = [Node(node_id=0, open=ALL_OPEN), Node(node_id=1)]
    assert not any(with_explored(nodes[0], MapGraph(nodes, [far]), ExploredRules()).explored)


def test_a_longer_edge_than_nodes_cover_leaves_the_ground_between_unexplored():
    """In a bare hall a view from two metres away still has many matches."""
    seen = Edge(a=0, b=1, heading_ab_rad=0.0, heading_ba_rad=math.pi, inliers=60, length_m=2.0)
    nodes = [Node(node_id=0, open=ALL_OPEN), Node(node_id=1)]
    graph = MapGraph(nodes, [seen])
    assert with_explored(nodes[0], graph, ExploredRules(), longest_m=2.1).explored[0]
    assert not any(with_explored(nodes[0], graph, ExploredRules(), longest_m=1.9).explored)


def test_beside_an_edge_a_way_that_was_seen_far_beyond_what_its_end_covers_stays_open():
    """As through a door beside the way to the next node."""
    near = Edge(a=0, b=1, heading_ab_rad=math.pi / 2, heading_ba_rad=-math.pi / 2, inliers=80, length_m=0.9)
    free_m = tuple(3.0 if sector == 2 else 1.5 for sector in range(12))
    nodes = [Node(node_id=0, open=ALL_OPEN, free_m=free_m), Node(node_id=1, open=ALL_OPEN)]
    graph = MapGraph(nodes, [near])

    def explored(covers_m):
        node = with_explored(nodes[0], graph, ExploredRules(), covers_m=covers_m)
        return [s for s in range(12) if node.explored[s]]

    assert explored(covers_m=1.0) == [3, 4]
    assert explored(covers_m=1.1) == [2, 3, 4]
    assert explored(covers_m=0.1) == [3], "straight along an edge its end has directions of its own"
