"""The nodes passed: each joined to the next, by the map where the way between two was not seen."""

from services.planner.routes.trail import Trail
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node

ROW = MapGraph([Node(node_id=n) for n in range(6)], [Edge(a=n, b=n + 1) for n in range(4)])


def test_nodes_are_kept_in_the_order_of_passing_also_there_and_back():
    trail = Trail(ROW)
    for node in (0, 1, 1, 2, 1, 0):
        assert trail.reach(ROW, node) == ()
    assert trail.nodes == (0, 1, 2, 1, 0)


def test_a_way_that_was_not_seen_is_filled_by_the_map():
    trail = Trail(ROW, (0,))
    assert trail.reach(ROW, 3) == (1, 2)
    assert trail.nodes == (0, 1, 2, 3)


def test_one_that_goes_on_leaves_out_what_is_gone_and_goes_round_it():
    around = MapGraph(
        [Node(node_id=n) for n in (0, 2, 3, 5)], [Edge(a=0, b=5), Edge(a=2, b=5), Edge(a=2, b=3)]
    )
    assert Trail(around, (0, 1, 2, 3)).nodes == (0, 5, 2, 3)
