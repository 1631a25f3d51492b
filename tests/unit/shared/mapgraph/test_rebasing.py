"""Of two robots that change one map at once, each keeps what it said and nobody's word is lost."""

import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.rebasing import rebased
from shared.messages.maps import AddNode, DeleteEdge, DeleteNode, Edge, Node, PutEdge, UpdateNode
from shared.messages.places import PutRoute, Route
from tests.bare_places import FEATURES, sectors


def add(node_id):
    return AddNode(node=Node(node_id=node_id), features=FEATURES)


@pytest.fixture
def before():
    nodes = [Node(node_id=0, explored=sectors(1)), Node(node_id=1)]
    return MapGraph(nodes, [Edge(a=0, b=1, traversals=1, failures=1, confidence=0.5)])


def changed(graph, *operations):
    now = MapGraph(graph.nodes.values(), graph.edges.values())
    now.apply(operations)
    return now


def test_a_new_place_takes_the_next_id_with_all_its_edges(before):
    now = changed(before, add(2), PutEdge(edge=Edge(a=1, b=2, inliers=9)))
    mine = [add(2), PutEdge(edge=Edge(a=0, b=2, inliers=40)), PutEdge(edge=Edge(a=1, b=2, inliers=30))]
    added, *edges = rebased(mine, before, now)
    assert added == add(3)
    assert [(e.edge.a, e.edge.b, e.edge.inliers) for e in edges] == [(0, 3, 40), (1, 3, 30)]


def test_directions_that_either_has_explored_stay_explored(before):
    now = changed(before, UpdateNode(node=Node(node_id=0, explored=sectors(1, 4))))
    [update] = rebased([UpdateNode(node=Node(node_id=0, explored=sectors(1, 7)))], before, now)
    assert update.node.explored == sectors(1, 4, 7)


def test_what_only_the_other_changed_of_an_edge_is_kept_and_counters_add_up(before):
    edge = before.edges[0, 1]
    theirs = edge.model_copy(update={"traversals": 3, "confidence": 0.9, "clear": True})
    mine = edge.model_copy(update={"traversals": 2, "failures": 0, "why": "driven"})
    [put] = rebased([PutEdge(edge=mine)], before, changed(before, PutEdge(edge=theirs)))
    assert (put.edge.traversals, put.edge.failures) == (4, 0)
    assert (put.edge.confidence, put.edge.clear, put.edge.why) == (0.9, True, "driven")


def test_nothing_is_said_about_what_is_gone(before):
    mine = [
        UpdateNode(node=Node(node_id=1)),
        PutEdge(edge=before.edges[0, 1]),
        DeleteEdge(a=0, b=1),
        DeleteNode(node_id=1),
    ]
    assert rebased(mine, before, changed(before, DeleteNode(node_id=1))) == []
    assert rebased(mine[1:3], before, changed(before, DeleteEdge(a=0, b=1))) == []


def test_an_edge_of_a_new_place_to_one_that_is_gone_is_left_out(before):
    mine = [add(2), PutEdge(edge=Edge(a=0, b=2)), PutEdge(edge=Edge(a=1, b=2))]
    now = changed(before, add(2), DeleteNode(node_id=0))
    assert rebased(mine, before, now) == [add(3), PutEdge(edge=Edge(a=1, b=3))]


def test_a_route_is_kept_without_the_nodes_that_are_gone(before):
    mine = [PutRoute(route=Route(name="tour", nodes=(0, 1, 0)))]
    assert rebased(mine, before, changed(before, add(2))) == mine
    gone = changed(before, DeleteNode(node_id=1))
    assert rebased(mine, before, gone) == [PutRoute(route=Route(name="tour", nodes=(0,)))]


def test_a_map_that_did_not_change_takes_the_same_operations(before):
    mine = [add(2), PutEdge(edge=Edge(a=0, b=2)), UpdateNode(node=Node(node_id=1, open=sectors(3)))]
    assert rebased(mine, before, before) == mine
