"""A robot found elsewhere once was carried; a leg on which it is lost twice is blamed."""

import math

import pytest

from services.planner.missions.goto import Goto
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import GOAL
from shared.messages.maps import Edge, Node
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges
from tests.plane_world import PlaneMap, picture

LEG = (0, 5)
"""The false one: place 5 seems to be in sight until the robot is on its way there."""


def match(place, inliers, status="ok", disparity_rad=0.2):
    return NodeMatch(
        node_id=place, raw_matches=2 * inliers, inliers=inliers, status=status, confidence=0.9,
        heading_rad=0.0, heading_std_rad=0.01, yaw_rad=0.0, disparity_rad=disparity_rad,
    )  # fmt: skip


class Lost:
    """A robot that always finds itself at place `here`; the goal is at place 5."""

    def __init__(self, here):
        self.here = here

    def match(self, node_ids, best_k=0, targets=()):  # noqa: ARG002
        if best_k:
            return {self.here: match(self.here, 200, "no_baseline", 0.0)}
        gone = list(node_ids[:1]) == [LEG[1]]
        places = {n: match(n, 5, "too_few") if gone else match(n, 60) for n in node_ids}
        return places | {GOAL: match(GOAL, 0, "too_few")}

    def locate(self, _features, _best_k):
        return {LEG[1]: match(LEG[1], 100, "no_baseline", 0.0)}


@pytest.fixture
def maps():
    graph = MapGraph([Node(node_id=n, open=(True,) * 12) for n in range(6)])
    for a, b in ((2, 3), (0, 2), LEG):
        values = edge_between(a, b, 0.0, 0.0) | {"disparity_rad": 0.1, "clear": True, "traversals": 1}
        graph.edges[a, b] = Edge.model_validate(values | {"inliers": 60, "confidence": 0.9})
    return PlaneMap(graph)


def drive(mission, steps):
    """Frames in an open field."""
    angles = tuple(k * math.tau / 12 for k in range(12))
    ranges = Ranges(robot="r1", seq=1, angles_rad=angles, distances_m=(4.0,) * 12, max_range_m=4.0)
    notes = []
    for seq in range(steps):
        frame = picture((0, 0, 0), seq)
        notes += [note.kind for note in mission.decide(Observation(frame, ranges)).notes]
    return notes


def test_a_robot_found_elsewhere_once_was_carried(maps):
    notes = drive(Goto(DEFAULT, maps, Lost(here=3), picture((9, 9, 0))), 12)
    assert notes.count("relocated") == 1
    assert maps.graph.edges[LEG].failures == 0


def test_a_leg_that_is_lost_twice_leads_elsewhere_than_the_map_says(maps):
    notes = drive(Goto(DEFAULT, maps, Lost(here=3), picture((9, 9, 0))), 60)
    assert notes.count("relocated") == 1
    assert maps.graph.edges[LEG].failures > 0
