"""A place is looked at again when the robot comes back to it."""

import math

import pytest

from services.planner.mapping.reobservation import close_known_directions
from services.planner.profiles import DEFAULT
from shared.mapgraph.frontiers import frontier_sectors
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import Edge, Node, PutEdge, UpdateNode
from tests.unit.services.planner.mapping.test_edges import Memory, match, observation

QUARTER = 3
"""Sectors in a right angle."""

AHEAD = {1: match(1, 90, 120), 2: match(2, 80, 110)}
"""Two nodes that support each other."""


def standing(yaw_rad):
    """About place 0, whose camera looks this way."""
    return Displacement(0, yaw_rad=-yaw_rad, spread_m=0.2)


@pytest.fixture
def maps():
    """Place 0 is open ahead and to its left; 1 is linked with 2, not with 0."""
    memory = Memory()
    opened = tuple(sector in (0, QUARTER) for sector in range(12))
    ahead = Edge(a=1, b=2, heading_ab_rad=0.3, heading_ba_rad=0.3 - math.pi, yaw_ab_rad=0.0)
    memory.commit([UpdateNode(node=Node(node_id=0, open=opened)), PutEdge(edge=ahead)])
    return memory


def test_a_direction_with_a_known_place_in_sight_is_no_longer_unexplored(maps):
    notes = close_known_directions(
        maps, observation(), {0: match(0, 300, 320), **AHEAD}, DEFAULT, standing(0.0)
    )
    assert frontier_sectors(maps.graph.nodes[0]) == [QUARTER]
    assert [note.kind for note in notes] == ["directions_seen"]
    assert maps.graph.neighbours(0) == [], "the robot only stands about there: no edge"


def test_directions_are_those_of_the_place_however_the_robot_stands(maps):
    """The robot is turned by 90 degrees to the right: what it sees ahead lies to the place's right."""
    close_known_directions(maps, observation(), AHEAD, DEFAULT, standing(math.pi / 2))
    assert frontier_sectors(maps.graph.nodes[0]) == [0, QUARTER]
    close_known_directions(maps, observation(), AHEAD, DEFAULT, standing(0.3 - math.pi / 2))
    assert frontier_sectors(maps.graph.nodes[0]) == [0]


def test_a_look_alike_that_stands_alone_closes_nothing(maps):
    assert close_known_directions(maps, observation(), {1: match(1, 90, 120)}, DEFAULT, standing(0.0)) == ()
    assert frontier_sectors(maps.graph.nodes[0]) == [0, QUARTER]


def test_without_news_nothing_is_written(maps):
    before = maps.graph.nodes[0]
    assert close_known_directions(maps, observation(), {0: match(0, 300, 320)}, DEFAULT, standing(0.0)) == ()
    assert maps.graph.nodes[0] == before
