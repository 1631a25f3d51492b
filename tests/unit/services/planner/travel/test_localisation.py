"""Where equal houses resemble the view, the part of the map counts that resembles it most in all."""

import pytest

from services.planner.profiles import DEFAULT, OUTDOOR
from services.planner.travel.localisation import nodes_around
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node
from shared.messages.matching import NodeMatch


def match(place, inliers, status="ok"):
    return NodeMatch(
        node_id=place, raw_matches=2 * inliers, inliers=inliers, status=status,
        heading_rad=0.0, heading_std_rad=0.01, yaw_rad=0.0,
    )  # fmt: skip


def seen(**inliers):
    return {int(name[1:]): match(int(name[1:]), count) for name, count in inliers.items()}


@pytest.fixture
def graph():
    """Places 0 to 11 in a row."""
    edges = [Edge(a=k, b=k + 1, heading_ab_rad=0.0, heading_ba_rad=3.1, yaw_ab_rad=0.0) for k in range(11)]
    return MapGraph([Node(node_id=n) for n in range(12)], edges)


def test_several_places_together_outweigh_a_look_alike(graph):
    assert nodes_around(graph, seen(n1=40, n2=35, n3=30, n10=60), OUTDOOR) == {1, 2, 3}


def test_the_place_the_robot_stands_at_outweighs_several_look_alikes(graph):
    assert nodes_around(graph, seen(n1=180, n9=50, n10=60, n11=50), OUTDOOR) == {1}


def test_a_robot_does_not_jump_to_a_look_alike(graph):
    seen_now = seen(n1=40, n9=84, n10=60, n11=48)
    assert nodes_around(graph, seen_now, OUTDOOR, last=0) == {1}
    assert nodes_around(graph, seen_now, OUTDOOR) == {9, 10, 11}


def test_a_robot_that_was_carried_is_where_it_stands(graph):
    assert nodes_around(graph, seen(n1=30, n10=180), OUTDOOR, last=0) == {10}
    assert nodes_around(graph, seen(n1=20, n10=60), OUTDOOR, last=0) == {10}


def test_what_no_edge_joins_any_more_lies_elsewhere(graph):
    cut = graph.edge(1, 2)
    graph.edges[1, 2] = cut.model_copy(update={"suspended": True})
    assert nodes_around(graph, seen(n0=40, n1=40, n2=50), OUTDOOR) == {0, 1}


def test_weak_or_doubtful_matches_do_not_count(graph):
    weak = {5: match(5, OUTDOOR.travel.s_via_min), 6: match(6, 300, status="inconsistent")}
    assert nodes_around(graph, weak, OUTDOOR) == set()
    assert nodes_around(graph, {**weak, 0: match(0, 30)}, OUTDOOR) == {0}


def test_where_nothing_repeats_every_match_counts(graph):
    matches = seen(n1=40, n10=60)
    assert nodes_around(graph, matches, DEFAULT) == set(matches)
