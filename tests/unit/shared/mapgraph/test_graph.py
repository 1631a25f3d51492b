"""The graph in memory: what operations change, and what nodes see of one another."""

import subprocess
import sys

import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.operations import GraphError
from shared.mapgraph.triangle import Sight
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, Node, PutEdge, UpdateNode

SEEN = Edge(a=0, b=1, heading_ab_rad=0.5, heading_ba_rad=-1.0, yaw_ab_rad=0.25)


def chain() -> MapGraph:
    return MapGraph([Node(node_id=n) for n in range(3)], [SEEN, Edge(a=1, b=2)])


def test_operations_change_nodes_edges_and_neighbours():
    graph = chain()
    assert graph.neighbours(1) == [0, 2]
    graph.apply(
        [PutEdge(edge=Edge(a=0, b=2)), DeleteEdge(a=1, b=2), UpdateNode(node=Node(node_id=2, keypoints=9))]
    )
    assert (graph.neighbours(1), graph.neighbours(2)) == ([0], [0])
    assert graph.nodes[2].keypoints == 9
    graph.apply([DeleteNode(node_id=0)])
    assert (sorted(graph.nodes), dict(graph.edges), graph.neighbours(1)) == ([1, 2], {}, [])


def test_what_is_made_of_the_edges_is_kept_until_they_change():
    graph, made = chain(), []

    def make() -> int:
        made.append(len(graph.edges))
        return made[-1]

    assert [graph.made_once("edges", make) for _ in range(3)] == [2, 2, 2]
    graph.apply([UpdateNode(node=Node(node_id=2, keypoints=9))])
    assert graph.made_once("edges", make) == 2
    graph.apply([DeleteEdge(a=1, b=2)])
    assert graph.made_once("edges", make) == 1
    assert made == [2, 1]


def test_an_operation_that_does_not_fit_is_an_error():
    with pytest.raises(GraphError, match="node 7 does not exist"):
        chain().apply([PutEdge(edge=Edge(a=1, b=7))])


def test_a_neighbour_is_seen_from_either_end_where_the_yaw_is_known():
    graph = chain()
    assert graph.sight(0, 1) == Sight(0.5, 0.25)
    assert graph.sight(1, 0) == Sight(-1.0, -0.25)
    assert graph.sight(1, 2) is None
    assert graph.sight(0, 2) is None


def test_edges_among_nodes_are_those_that_may_be_used_and_join_two_of_them():
    edges = [Edge(a=1, b=2), Edge(a=0, b=1), Edge(a=0, b=2, suspended=True), Edge(a=2, b=3)]
    graph = MapGraph([Node(node_id=n) for n in range(4)], edges)
    assert [(edge.a, edge.b) for edge in graph.edges_among({2, 1, 0})] == [(0, 1), (1, 2)]
    assert graph.edges_among([1]) == []


def test_nodes_within_a_cost_are_those_that_allowed_edges_lead_to():
    graph = MapGraph([Node(node_id=n) for n in range(4)], [Edge(a=n, b=n + 1) for n in range(3)])
    assert graph.within_cost(0, 2.0, lambda _: 1.0) == {0, 1, 2}
    assert graph.within_cost(0, 9.0, lambda edge: None if edge.a == 1 else 1.0) == {0, 1}


def test_a_way_takes_driven_edges_rather_than_few_long_jumps():
    driven = [Edge(a=n, b=n + 1, length_m=1.0) for n in range(2)]
    jump = Edge(a=0, b=2)
    graph = MapGraph([Node(node_id=n) for n in range(6)], [*driven, jump, Edge(a=3, b=4, suspended=True)])
    assert graph.way(0, 2) == [0, 1, 2]
    assert MapGraph(graph.nodes.values(), [jump]).way(0, 2) == [0, 2]
    assert (graph.way(1, 1), graph.way(0, 5), graph.way(3, 4), graph.way(0, 99)) == ([1], [], [], [])


def test_who_keeps_or_shows_maps_starts_without_networkx():
    """Loading it took a fifth of their start."""
    code = "import sys, services.gateway.app, services.map_store.api.app; sys.exit('networkx' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
