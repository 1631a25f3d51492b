"""An edge to a far part of the map needs a neighbour there that fits."""

import math

import pytest

from shared.mapgraph.cycle_consistency import (
    contradicted,
    is_consistent,
    supported_by,
    unsupported_loop_closures,
)
from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node
from shared.messages.matching import NodeMatch

POSES = [(float(x), 0.0, 0.1 * x) for x in range(8)] + [(7.0, 1.0, 0.5), (0.5, 1.0, -0.3)]
"""Places 0 to 7 in a row, 8 beside the last one, and the pose of the new frame."""

FRAME = 9


def relation(first, second):
    """Heading and yaw of the second pose seen from the first."""
    (x, y, yaw), (u, v, turned) = POSES[first], POSES[second]
    return math.atan2(v - y, u - x) - yaw, math.remainder(turned - yaw, math.tau)


def match(node, turned_rad=0.0, aside_rad=0.0):
    heading, yaw = relation(FRAME, node)
    return NodeMatch(
        node_id=node,
        raw_matches=90,
        inliers=70,
        status="ok",
        heading_rad=math.remainder(heading + aside_rad, math.tau),
        yaw_rad=math.remainder(yaw + turned_rad, math.tau),
    )


@pytest.fixture
def graph():
    ends = [(k, k + 1) for k in range(7)] + [(7, 8), (6, 8)]
    edges = [Edge.model_validate(edge_between(a, b, *relation(a, b))) for a, b in ends]
    return MapGraph([Node(node_id=n) for n in range(9)], edges)


def test_nodes_near_where_the_robot_came_from_need_no_supporting_neighbour(graph):
    assert unsupported_loop_closures(graph, {0: match(0), 1: match(1)}, driven_from=0) == {}


def test_a_far_node_needs_a_neighbour_that_fits(graph):
    assert set(unsupported_loop_closures(graph, {0: match(0), 7: match(7)}, driven_from=0)) == {7}
    seen = {0: match(0), 7: match(7), 6: match(6)}
    assert unsupported_loop_closures(graph, seen, driven_from=0) == {}


def test_a_carried_robot_is_asked_for_none(graph):
    assert unsupported_loop_closures(graph, {7: match(7)}, driven_from=None) == {}


def test_nodes_support_one_another_in_a_chain(graph):
    seen = {n: match(n) for n in (4, 5, 6)}
    assert supported_by(graph, seen, {4}) == {5, 6}
    assert supported_by(graph, seen | {5: match(5, turned_rad=0.3)}, {4}) == set(), "the chain is broken"
    assert supported_by(graph, seen, set()) == set(), "somebody must be sure"


@pytest.mark.parametrize("node", [6, 7, 8])
def test_true_neighbours_agree(graph, node):
    for neighbour in graph.neighbours(node):
        assert is_consistent(graph, {node: match(node), neighbour: match(neighbour)}, node, neighbour)


def test_a_turn_that_does_not_add_up_disagrees(graph):
    seen = {7: match(7, turned_rad=math.radians(12.0)), 8: match(8)}
    assert not is_consistent(graph, seen, 7, 8)


def test_directions_that_cannot_close_disagree(graph):
    seen = {7: match(7), 8: match(8, aside_rad=math.radians(-40.0))}
    assert not is_consistent(graph, seen, 7, 8)


def test_where_the_frame_stands_at_the_node_only_the_turn_counts(graph):
    here = match(7).model_copy(update={"status": "no_baseline", "heading_rad": None})
    assert is_consistent(graph, {7: here, 8: match(8)}, 7, 8)


def test_true_nodes_are_not_outvoted(graph):
    assert contradicted(graph, {n: match(n) for n in range(9)}) == {}


@pytest.mark.parametrize("node", [0, 3, 7])
def test_a_node_seen_the_wrong_way_round_is_outvoted(graph, node):
    seen = {n: match(n) for n in range(9)} | {node: match(node, aside_rad=math.pi)}
    assert set(contradicted(graph, seen)) == {node}


def test_of_two_that_disagree_the_better_verified_stays(graph):
    weak = match(6, aside_rad=math.pi).model_copy(update={"inliers": 40})
    assert set(contradicted(graph, {6: weak, 7: match(7)})) == {6}


def test_a_node_without_neighbours_in_view_is_not_judged(graph):
    assert contradicted(graph, {0: match(0, aside_rad=math.pi), 7: match(7)}) == {}


def test_a_match_too_ambiguous_for_an_edge_still_votes(graph):
    """Place 7 seems to lie aside; 6 would tell, though a second motion explains its own view."""
    aside = match(7, aside_rad=math.radians(25.0))
    assert contradicted(graph, {7: aside}) == {}
    assert set(contradicted(graph, {7: aside}, {6: match(6), 7: aside})) == {7}
    assert contradicted(graph, {7: match(7)}, {6: match(6), 7: match(7)}) == {}
