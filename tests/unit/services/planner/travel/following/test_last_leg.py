"""A goal that does not show is headed for by where the map has it."""

import math

import pytest

from services.planner.travel.following.last_leg import along_edges, reckoned_rad
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(4, 2)


def degrees(here, goal):
    found = reckoned_rad(GRAPH, here, goal)
    return None if found is None else math.degrees(found)


def test_it_lies_where_its_node_lies_and_so_far_from_it():
    goal = Displacement(1, x_m=0.0, y_m=1.5)
    assert degrees(Displacement(1), goal) == pytest.approx(90.0)
    assert degrees(Displacement(0, x_m=-0.5), goal) == pytest.approx(45.0, abs=1.0)


def test_the_bearing_is_that_in_the_frame_of_the_robot():
    goal = Displacement(1, x_m=2.0)
    assert degrees(Displacement(0, yaw_rad=math.pi / 2), goal) == pytest.approx(-90.0, abs=1.0)


@pytest.mark.parametrize(
    ("here", "goal"),
    [
        (Displacement(1, x_m=0.9), Displacement(1, x_m=1.0)),
        (None, Displacement(1, x_m=1.0)),
        (Displacement(0), None),
        (Displacement(99), Displacement(1, x_m=1.0)),
        (Displacement(0), Displacement(99, x_m=1.0)),
    ],
)
def test_at_the_spot_or_where_nobody_knows_there_is_no_bearing(here, goal):
    assert reckoned_rad(GRAPH, here, goal) is None


def test_along_edges_a_node_lies_where_they_lead_suspended_ones_too():
    graph = MapGraph(
        GRAPH.nodes.values(), [e.model_copy(update={"suspended": True}) for e in GRAPH.edges.values()]
    )
    there, back = along_edges(graph, [1, 2, 6]), along_edges(graph, [6, 2, 1])
    assert (there.node_id, there.x_m, there.y_m) == pytest.approx((1, 1.0, 1.0))
    assert (back.node_id, back.x_m, back.y_m) == pytest.approx((6, -1.0, -1.0))
    assert reckoned_rad(graph, Displacement(1), there) == pytest.approx(math.pi / 4)


def test_along_an_edge_to_a_camera_that_looks_elsewhere_the_next_one_is_turned():
    turned = [e.model_copy(update={"yaw_ab_rad": math.pi / 2}) for e in GRAPH.edges.values()]
    there = along_edges(MapGraph(GRAPH.nodes.values(), turned), [0, 1, 2])
    assert (there.x_m, there.y_m) == pytest.approx((1.0, 1.0))


def test_along_an_edge_that_is_not_there_nothing_is_known():
    assert along_edges(GRAPH, [0, 3]) is None
