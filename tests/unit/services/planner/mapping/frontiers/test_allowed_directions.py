"""Unexplored directions that lead to a keep-out are left alone; the map is not told. On a grid of a metre."""

import math

import pytest

from services.planner.mapping.frontiers.allowed_directions import AllowedDirections
from shared.mapgraph.frontiers import frontier_sectors
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import UpdateNode
from shared.messages.places import DeleteRule, KeepOut, PutRule
from tests.plane_world import PlaneMap
from tests.unit.shared.mapgraph.local.grid import grid

COLUMNS = 5
CENTRE, LEFT, BELOW, CORNER = 12, 11, 7, 0
ALL = tuple(range(12))


@pytest.fixture
def maps():
    """All directions of all nodes are open and none is explored; nobody may go to the node in the middle."""
    found = PlaneMap(grid(COLUMNS, COLUMNS))
    nodes = list(found.graph.nodes.values())
    found.commit([UpdateNode(node=n.model_copy(update={"open": (True,) * 12})) for n in nodes])
    found.commit([PutRule(rule=KeepOut(name="shut", nodes=(CENTRE,)))])
    return found


def test_a_forbidden_node_is_left_by_no_direction_and_one_far_away_by_all(maps):
    directions = AllowedDirections(maps)
    assert directions.of(CENTRE) == []
    assert directions.of(CORNER) == list(ALL)


@pytest.mark.parametrize(("node", "towards"), [(LEFT, 0), (BELOW, 3), (CENTRE + 1, 6), (CENTRE + COLUMNS, 9)])
def test_a_neighbour_is_left_by_all_directions_but_those_towards_it(maps, node, towards):
    allowed = AllowedDirections(maps).of(node)
    assert towards not in allowed
    assert {(towards + turn) % 12 for turn in (4, 5, 6, 7, 8)} <= set(allowed)


def test_what_was_refused_stays_so_for_the_mission_and_is_open_in_the_map(maps):
    directions = AllowedDirections(maps)
    directions.refuse(CORNER, 4)
    assert directions.of(CORNER) == [s for s in ALL if s != 4]
    maps.commit([DeleteRule(name="shut")])
    assert AllowedDirections(maps).of(LEFT) == list(ALL) == frontier_sectors(maps.graph.nodes[LEFT])


@pytest.mark.parametrize(
    ("x_m", "heading_rad", "rule"),
    [(0.1, 0.0, "shut"), (-0.6, 0.0, ""), (0.1, math.pi, ""), (0.1, math.pi / 2, ""), (0.1, 0.3, "shut")],
)
def test_a_departure_is_told_when_it_comes_near(maps, x_m, heading_rad, rule):
    """From the node a metre left of the forbidden one, ahead along x; the camera is turned by a quarter."""
    here = Displacement(LEFT, x_m=x_m, yaw_rad=math.pi / 2)
    assert AllowedDirections(maps).ahead(here, heading_rad - math.pi / 2) == rule
