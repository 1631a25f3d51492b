"""Ways that keep clear of forbidden nodes, by where the edges put them: on a grid of a metre."""

import pytest

from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.keep_clear import (
    CLEAR_M,
    clear_nodes,
    current_limits,
    is_near_forbidden,
    keep_clear,
)
from shared.messages.places import KeepOut, PutRule
from shared.wall_clock import WallClock
from tests.unit.shared.mapgraph.local.grid import GRID_HALF_M, edge, grid

NOON = WallClock(29_923_920)
COLUMNS = 5
CENTRE = 12
CARRIES = GRID_HALF_M / 0.32
"""How many times further views carry on the grid than in a room: distances to keep grow with it."""


def around(root, forbidden=(CENTRE,)):
    found = keep_clear(grid(COLUMNS, COLUMNS), root, forbidden)
    assert found is not None
    return found


def test_the_distance_to_keep_grows_with_how_far_views_carry():
    assert around(0).clear_m == pytest.approx(CLEAR_M * CARRIES, rel=0.1)


@pytest.mark.parametrize(
    ("end_m", "crossed"),
    [((1.0, 0.0), True), ((4.0, 0.0), True), ((0.0, 1.0), False), ((-1.0, 0.0), False), ((1.0, 2.5), False)],
)
def test_a_way_towards_a_forbidden_node_is_crossed_and_one_aside_or_away_is_not(end_m, crossed):
    """From node 11, left of the centre by a metre."""
    assert around(11).is_crossed((0.0, 0.0), end_m) is crossed


def test_a_way_to_a_neighbour_along_an_area_is_none_into_it():
    beside = around(11)
    assert not beside.is_crossed_to((0.0, 0.0), 6)
    assert not beside.is_crossed_to((0.0, 0.0), 16)
    assert beside.is_crossed_to((0.0, 0.0), 13)


def test_far_from_forbidden_nodes_nothing_is_kept_clear():
    flat = grid(COLUMNS, COLUMNS)
    assert keep_clear(flat, 0, ()) is None
    assert not is_near_forbidden(flat, Displacement(0), ())
    assert is_near_forbidden(flat, Displacement(0), {CENTRE})
    assert is_near_forbidden(flat, None, {CENTRE})


def test_nodes_behind_a_forbidden_one_are_not_driven_to_straight_from_where_the_robot_is():
    flat, here = grid(COLUMNS, COLUMNS), Displacement(11, x_m=-0.2, y_m=0.1)
    assert clear_nodes(flat, here, [13, 6, 10, 16], {CENTRE}) == [6, 10, 16]
    assert clear_nodes(flat, None, [13, 6], {CENTRE}) == [13, 6]


def test_a_long_edge_over_a_forbidden_node_is_closed_and_its_name_told():
    flat = grid(COLUMNS, COLUMNS)
    flat.edges[11, 13] = edge(11, 13, COLUMNS)
    flat.apply([PutRule(rule=KeepOut(name="shut", nodes=(CENTRE,)))])
    limits = current_limits(flat, NOON)
    assert (limits.closed[11, 13], limits.closed[13, 11]) == ("shut", "shut")
    assert (11, 6) not in limits.closed
    assert limits.against_path([10, 11, 13]) == "shut"
