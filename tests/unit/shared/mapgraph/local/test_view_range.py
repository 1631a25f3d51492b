"""How far views carry is learnt from driven edges, place by place, and tells distances by matches."""

import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import (
    ROOM_HALF_M,
    edge_length_m,
    half_m,
    match_length_m,
    openness,
)
from shared.messages.maps import Edge
from tests.unit.shared.mapgraph.local.places import inliers_at, row


def test_a_robot_that_drove_nowhere_takes_every_place_for_a_room():
    assert half_m(MapGraph()) == ROOM_HALF_M
    assert half_m(MapGraph(*row(2, 0.6)), 0) == ROOM_HALF_M, "one edge is not enough to believe"


@pytest.mark.parametrize("carries_m", [0.25, 0.4, 0.7])
def test_driven_edges_tell_how_far_views_carry(carries_m):
    assert half_m(MapGraph(*row(10, carries_m)), 5) == pytest.approx(carries_m, rel=0.03)


def test_a_hall_and_the_yard_behind_it_are_told_apart():
    hall, yard = row(40, 0.3), row(40, 0.7, first=40)
    door = Edge(a=39, b=40, inliers=100, length_m=0.7, traversals=1)
    graph = MapGraph([*hall[0], *yard[0]], [*hall[1], *yard[1], door])
    assert half_m(graph, 5) == pytest.approx(0.3, rel=0.03)
    assert half_m(graph, 75) == pytest.approx(0.7, rel=0.03)
    assert openness(graph, 5) == 1.0, "no place is less open than a room"
    assert openness(graph, 75) == pytest.approx(0.7 / ROOM_HALF_M, rel=0.03)


def test_ways_hardly_longer_than_a_step_and_what_was_only_seen_tell_nothing():
    nodes, edges = row(10, 0.7)
    seen = [edge.model_copy(update={"length_m": None}) for edge in edges]
    short = [edge.model_copy(update={"length_m": 0.2}) for edge in edges]
    assert half_m(MapGraph(nodes, seen), 5) == half_m(MapGraph(nodes, short), 5) == ROOM_HALF_M


@pytest.mark.parametrize("keypoints", [150, 300, 1000])
@pytest.mark.parametrize("distance_m", [0.1, 0.5, 2.0, 6.0])
def test_matches_tell_the_distance_whatever_the_number_of_keypoints(distance_m, keypoints):
    inliers = inliers_at(distance_m, 0.4, keypoints)
    assert match_length_m(inliers, keypoints, 0.4) == pytest.approx(distance_m, rel=0.1, abs=0.02)


def test_an_edge_is_as_long_as_it_was_driven_else_as_its_matches_say():
    nodes, edges = row(10, 0.4)
    far = Edge(a=0, b=9, inliers=inliers_at(3.0, 0.4))
    graph = MapGraph(nodes, [*edges, far])
    assert edge_length_m(graph, graph.edge(0, 1)) == 0.7
    assert edge_length_m(graph, graph.edge(0, 9)) == pytest.approx(3.0, rel=0.05)


def test_pictures_without_a_match_in_common_are_far_apart_and_equal_ones_at_one_spot():
    assert match_length_m(0, 300, 0.32) > 50.0
    assert match_length_m(300, 300, 0.32) < 0.05
