"""A sight of a node that lies elsewhere is refused."""

import math

import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement, seen_from
from shared.mapgraph.local.reach import LOOP_NODES, hanging_apart, out_of_reach
from shared.messages.maps import Node
from shared.motion.motion import Motion
from tests.unit.shared.mapgraph.local.grid import claim, edge, grid

GRAPH = grid(8, 3)
HERE = Displacement(0, x_m=0.5, y_m=0.0, spread_m=0.1)
"""Half a metre from node 0 towards node 1."""


def refused(claims, here=HERE):
    return set(out_of_reach(GRAPH, claims, here))


def test_a_node_where_it_is_seen_is_in_reach():
    assert refused({1: claim(0.5, 0.0), 2: claim(1.5, 0.0), 9: claim(0.5, 1.0)}) == set()


def test_a_node_a_period_further_is_out_of_reach():
    assert refused({5: claim(0.5, 0.0), 6: claim(0.5, 0.2), 1: claim(0.5, 0.0)}) == {5, 6}


def test_what_surely_lies_too_far_away_is_refused():
    seen = {1: claim(0.5, 0.0), 6: claim(5.5, 0.0)}
    assert refused(seen) == set()
    assert set(out_of_reach(GRAPH, seen, HERE, longest_m=3.0)) == {6}
    assert not out_of_reach(GRAPH, {4: claim(3.5, 0.0)}, HERE, longest_m=3.4), "not surely"


def test_with_no_free_ground_seen_up_to_it_a_node_that_likely_lies_too_far_away_is_refused():
    seen = {3: claim(2.5, 0.0), 4: claim(3.5, 0.0)}
    assert set(out_of_reach(GRAPH, seen, HERE, longest_m=3.4, hidden={3, 4})) == {4}
    assert not out_of_reach(GRAPH, seen, HERE, hidden={3, 4})


def test_what_is_seen_on_the_wrong_side_is_out_of_reach():
    assert refused({2: claim(-1.5, 0.0)}) == {2}


def test_yaws_round_a_loop_must_close():
    reasons = out_of_reach(GRAPH, {1: claim(0.5, 0.0, yaw_rad=math.radians(90))}, HERE)
    assert "turned by 90 degrees" in reasons[1]
    assert refused({1: claim(0.5, 0.0, yaw_rad=math.radians(4))}) == set()


def test_a_spot_is_no_other_spot():
    assert refused({0: claim(0.0, 0.0), 4: claim(0.0, 0.0)}) == {4}


def test_a_robot_that_drove_far_without_a_sight_may_be_further():
    strayed = Displacement(0, x_m=0.5, spread_m=2.0)
    assert refused({5: claim(0.5, 0.0)}, strayed) == set()


def test_nothing_is_known_of_what_no_edge_joins_or_without_a_node_to_start_from():
    assert refused({1: claim(9.0, 0.0)}, Displacement(99)) == set()


@pytest.mark.parametrize(("driven", "apart"), [(False, {4}), (True, set())])
def test_a_node_on_an_edge_that_nobody_drove_is_where_its_matches_say(driven, apart):
    """It lies 3.5 m ahead; what looks like it 0.9 m ahead is another."""
    row, last = grid(4, 1), edge(3, 4, 8, driven=driven)
    hanging = MapGraph([*row.nodes.values(), Node(node_id=4)], [*row.edges.values(), last])
    seen = {2: claim(1.5, 0.0), 4: claim(0.9, 0.0)}
    assert out_of_reach(hanging, seen, HERE).keys() == {4} - apart
    assert hanging_apart(hanging, seen, HERE, 60) == apart
    assert hanging_apart(hanging, {4: claim(2.0, 0.0)}, HERE, 60) == set()
    assert hanging_apart(hanging, seen, Displacement(99), 60) == set()


def test_driving_adds_up_in_the_frame_of_the_node_and_grows_uncertain():
    here = Displacement(3, yaw_rad=math.pi / 2).moved(Motion(1.0, 0.0)).moved(Motion(0.0, 1.0))
    assert math.dist((here.x_m, here.y_m), (-1.0, 1.0)) < 1e-9
    assert 0.2 < here.spread_m < 0.4


def test_the_bearing_of_the_node_left_corrects_the_direction():
    drifted = Displacement(3, x_m=1.0, y_m=0.2)
    seen = drifted.turned(yaw_rad=0.1, heading_rad=math.pi + 0.1)
    assert math.dist((seen.x_m, seen.y_m), (drifted.length_m, 0.0)) < 1e-9
    assert seen.yaw_rad == -0.1


def test_where_a_frame_is_by_what_it_sees_of_one_node():
    here = seen_from(3, heading_rad=0.0, yaw_rad=0.0, length_m=2.0, spread_m=0.1)
    assert math.dist((here.x_m, here.y_m), (-2.0, 0.0)) < 1e-9


def line(nodes):
    """A way of so many metres, straight on."""
    return MapGraph(
        [Node(node_id=n) for n in range(nodes)], [edge(n, n + 1, nodes) for n in range(nodes - 1)]
    )


def test_a_look_alike_beyond_all_nodes_reckoned_with_together_is_out_of_reach():
    there = LOOP_NODES + 40
    graph, here = line(there + 10), Displacement(0, x_m=0.5, spread_m=0.1)
    assert set(out_of_reach(graph, {there: claim(0.5, 0.0), 1: claim(0.5, 0.0)}, here)) == {there}
    turned = {there: claim(there - 0.5, 0.0, yaw_rad=math.pi)}
    assert "turned by 180 degrees" in out_of_reach(graph, turned, here)[there]
    assert out_of_reach(graph, turned, here, LOOP_NODES) == {}, "nothing is known of it"


def test_a_loop_longer_than_that_may_close():
    half = LOOP_NODES // 2 + 30
    graph = grid(half, 2)
    apart = [e for (a, b), e in graph.edges.items() if (a < half) == (b < half) or a == half - 1]
    ring = MapGraph(graph.nodes.values(), [e for e in apart if (e.a, e.b) != (half - 1, 2 * half - 2)])
    assert half not in ring.nearest(0, LOOP_NODES)
    assert out_of_reach(ring, {half: claim(0.0, 1.0)}, Displacement(0)) == {}
