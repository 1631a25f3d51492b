"""Which matches become edges of a new place."""

import math

import numpy as np
import pytest

from services.planner.mapping.edges import NewEdges, judge_edges, stands_alone
from services.planner.mapping.nodes import add_node
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT, PHOTO, THESIS
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.messages.features import Features
from shared.messages.maps import Edge, Node, PutEdge
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

HERE = Displacement(0, spread_m=9.0)
"""From place 0, and gone astray since."""


class Memory:
    def __init__(self):
        self.graph = MapGraph([Node(node_id=n) for n in range(3)])

    def commit(self, operations):
        self.graph.apply(operations)


def observation():
    arrays = np.zeros((1, 2), np.float32), np.zeros(1, np.float32), np.zeros((1, 4), np.float32)
    features = Features(pipeline="p", lonlat_rad=arrays[0], scores=arrays[1], descriptors=arrays[2])
    ranges = Ranges(
        robot="r1", angles_rad=tuple(np.arange(12) * 0.5), distances_m=(4.0,) * 12, max_range_m=4.0
    )
    return Observation(features, ranges)


def match(node_id, inliers, raw):
    return NodeMatch(
        node_id=node_id,
        raw_matches=raw,
        inliers=inliers,
        status="ok",
        heading_rad=0.3,
        heading_std_rad=0.01,
        yaw_rad=0.0,
        disparity_rad=0.1,
        confidence=0.8,
    )


def edges_of(profile, *matches, driven_from=None):
    maps = Memory()
    here = Displacement(driven_from, spread_m=9.0) if driven_from is not None else None
    edges = judge_edges(maps.graph, observation(), {m.node_id: m for m in matches}, profile, here)
    node, _ = add_node(maps, observation(), edges, profile, here)
    return maps.graph.neighbours(node)


def test_a_node_out_of_sight_of_free_ground_is_an_edge_and_said_to_be_none_that_is_clear():
    blocked = Observation(
        observation().features, observation().ranges.model_copy(update={"distances_m": (0.5,) * 12})
    )
    graph = Memory().graph
    for seen, clear in ((observation(), {0}), (blocked, set())):
        edges = judge_edges(graph, seen, {0: match(0, 71, 120)}, DEFAULT, None)
        assert set(edges.admitted) == {0}
        assert edges.clear == clear


def test_a_node_too_uncertain_for_an_edge_leaves_nothing_unexplored_that_way():
    """Few matches that hardly move may be far away; its neighbour supports it."""
    maps = Memory()
    maps.commit(
        [PutEdge(edge=Edge(a=0, b=1, heading_ab_rad=0.3, heading_ba_rad=0.3 - math.pi, yaw_ab_rad=0.0))]
    )
    sure = {"noise_rad": math.radians(0.3), "moved": 60}
    weak = match(1, 45, 80).model_copy(update={**sure, "disparity_rad": 0.11})
    strong = match(0, 90, 120).model_copy(update=sure)
    edges = judge_edges(maps.graph, observation(), {0: strong, 1: weak}, PHOTO, HERE)
    assert set(edges.admitted) == {0}
    assert set(edges.covered) == {1}
    node, _ = add_node(maps, observation(), edges, PHOTO, HERE)
    assert maps.graph.neighbours(node) == [0]


def test_a_match_that_stands_alone_is_an_edge_without_free_ground():
    assert stands_alone(match(0, 35, 80), DEFAULT)
    assert not stands_alone(match(0, 25, 80), DEFAULT)
    assert not stands_alone(match(0, 35, 80).model_copy(update={"confidence": 0.4}), DEFAULT)


def test_a_doubtful_bearing_is_an_edge_only_along_what_the_robot_drove():
    doubtful = match(0, 71, 120).model_copy(update={"confidence": 0.6})
    assert edges_of(DEFAULT, doubtful) == []
    assert edges_of(DEFAULT, doubtful, driven_from=0) == [0]
    assert edges_of(THESIS, doubtful) == [0]
    assert not stands_alone(doubtful, DEFAULT)


def test_a_node_keeps_what_the_distance_sensors_read_around_it():
    maps = Memory()
    read_m = tuple(0.5 + 0.011 * n for n in range(12))
    ranges = observation().ranges.model_copy(
        update={"angles_rad": tuple(np.arange(12) * math.tau / 12), "distances_m": read_m}
    )
    node, _ = add_node(maps, Observation(observation().features, ranges), NewEdges(), DEFAULT, None)
    assert maps.graph.nodes[node].echoes_m == pytest.approx(read_m, abs=0.006)


def test_what_is_seen_alike_from_far_away_is_no_edge():
    """Two rooms with one view out of the window, and a room whose furniture stands a little differently."""
    near = match(0, 90, 120).model_copy(update={"noise_rad": math.radians(0.3), "moved": 60})
    assert stands_alone(near, PHOTO)
    assert not stands_alone(near.model_copy(update={"moved": 20}), PHOTO)
    assert not stands_alone(near.model_copy(update={"moved": None}), PHOTO)
    assert not stands_alone(near.model_copy(update={"noise_rad": math.radians(0.6)}), PHOTO)
    assert not stands_alone(near.model_copy(update={"disparity_rad": math.radians(1.8)}), PHOTO)
    assert stands_alone(near.model_copy(update={"moved": 20}), DEFAULT)
    few = near.model_copy(update={"inliers": 44, "moved": 42})
    assert not stands_alone(few, PHOTO)  # who stands that near shares more
    assert stands_alone(few.model_copy(update={"disparity_rad": 0.3}), PHOTO)


def test_a_match_that_two_motions_explain_does_not_stand_alone(monkeypatch):
    monkeypatch.setattr("services.planner.mapping.edges.is_ambiguous", lambda _: True)
    assert not stands_alone(match(0, 60, 80), DEFAULT)
    assert stands_alone(match(0, 60, 80), THESIS)  # its rules know no such thing


def test_a_node_knows_how_far_the_robot_came_even_where_a_corner_hides_what_it_left():
    maps = Memory()
    behind = Edge(a=0, b=1, heading_ab_rad=0.3, heading_ba_rad=0.3 - math.pi, yaw_ab_rad=0.0, length_m=1.0)
    maps.commit([PutEdge(edge=behind)])
    back_rad = 0.3 - math.pi
    here = Displacement(1, x_m=0.5 * math.cos(0.3), y_m=0.5 * math.sin(0.3), spread_m=0.1)
    sight = match(0, 90, 120).model_copy(update={"heading_rad": back_rad, "disparity_rad": 0.2})
    edges = judge_edges(maps.graph, observation(), {0: sight}, DEFAULT, here)
    node, _ = add_node(maps, observation(), edges, DEFAULT, here)
    edge = maps.graph.edge(0, node)
    assert edge is not None
    assert edge.length_m == pytest.approx(1.5, abs=0.05)
    assert edge.length_std_m > 0.1
    assert edge.traversals == 0, "it did not drive along it"
