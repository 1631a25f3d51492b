"""Teaching on the true floor plan: a person drives, and what is mapped can be driven and explored further."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.mission_kinds import MissionContext, MissionError, mission_kinds
from services.planner.profiles import DEFAULT
from shared.mapgraph.frontiers import open_directions
from shared.messages.maps import DeleteEdge, DeleteNode
from shared.messages.places import PutRoute, Route
from tests.plane_person import lead
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, run

START = (2.6, 1.3, 0.0)
LOOP = ((1.1, 3.2), (2.2, 5.2), (4.6, 5.2), (4.55, 3.0), (4.0, 1.3), START[:2])
WRONG_RAD = math.radians(20.0)
SPOT_M = 0.3
"""Between nodes nearer than that no direction is worth a judgement."""


class Blinkered(PlaneMatcher):
    """Sees no node while `corner` hides them, though a frame still resembles the one before it."""

    corner = False

    def match(self, node_ids, best_k=0, targets=()):
        found = super().match(node_ids, best_k, targets)
        return {node: match for node, match in found.items() if node < 0 or not self.corner}


class Flat:
    """A robot in the apartment and a person beside it."""

    def __init__(self, seed=1):
        self.world, self.maps = PlaneWorld(START, np.random.default_rng(seed)), PlaneMap()
        self.matcher = Blinkered(self.world, self.maps)

    def start(self, kind, checkpoint=None, **parameters):
        context = MissionContext(
            DEFAULT, self.maps, self.matcher, np.random.default_rng(0), checkpoint=checkpoint or {}
        )
        return mission_kinds()[kind].start(context, parameters)

    def false_edges(self):
        """Edges whose direction is another one than the true one."""
        poses = self.maps.poses
        return [
            key for key, edge in self.maps.graph.edges.items() if _is_false(edge, *(poses[n] for n in key))
        ]

    def away_m(self, node):
        """True distance of the robot from a node."""
        return math.dist(self.maps.poses[node][:2], self.world.pose[:2])


def _is_false(edge, a, b):
    true_rad = math.atan2(b[1] - a[1], b[0] - a[0]) - a[2]
    off_rad = abs(math.remainder(true_rad - edge.heading_ab_rad, math.tau))
    return math.dist(a[:2], b[:2]) > SPOT_M and off_rad > WRONG_RAD


def kinds_of(said):
    return {note.kind for _, decision in said for note in decision.notes}


@pytest.fixture(scope="module")
def loop():
    """A flat in which a person drove a loop, the mission, and what it said."""
    flat = Flat()
    mission = flat.start("teach", route="tour")
    return flat, mission, lead(flat.world, mission, LOOP)


def test_a_way_is_mapped_without_false_edges_each_node_joined_to_the_next_by_a_driven_edge(loop):
    flat, mission, said = loop
    passed, graph = mission.progress.via_points, flat.maps.graph
    assert len(passed) > 12
    assert all(graph.edge(*leg) is not None and graph.edge(*leg).traversals for leg in pairwise(passed))
    assert flat.false_edges() == []
    assert {decision.action for _, decision in said} == {"hold"}
    assert not any(decision.outcome for _, decision in said)


def test_a_loop_is_closed_where_it_began(loop):
    _, mission, _ = loop
    passed = mission.progress.via_points
    assert passed[0] == passed[-1] == 0


def test_finishing_keeps_the_way_as_a_route_and_leaves_more_to_explore(loop):
    flat, mission, _ = loop
    told = mission.finish()
    assert "route 'tour' leads along" in told
    assert flat.maps.graph.routes["tour"].nodes == mission.progress.via_points
    assert open_directions(flat.maps.graph) > 0
    before = len(flat.maps.graph.nodes)
    run(flat.world, flat.start("explore"), DriveLimits(), 60)
    assert len(flat.maps.graph.nodes) > before
    with pytest.raises(MissionError, match="has a route 'Tour' already"):
        flat.start("teach", route="Tour")


def test_a_robot_that_stops_between_nodes_gets_one_there():
    flat = Flat()
    mission = flat.start("teach", route="short")
    lead(flat.world, mission, [(2.2, 1.3)])
    before = len(flat.maps.graph.nodes)
    mission.finish()
    assert len(flat.maps.graph.nodes) == before + 1
    assert flat.away_m(flat.maps.graph.routes["short"].nodes[-1]) < 0.01


def test_a_route_of_one_node_is_refused_and_the_mission_goes_on():
    flat = Flat()
    mission = flat.start("teach", route="none")
    mission.decide(flat.world.observe())
    with pytest.raises(MissionError, match="would have 1 nodes: drive on, or cancel"):
        mission.finish()
    assert mission.decide(flat.world.observe()).why.startswith("going along from node 0")


def test_out_of_sight_it_says_so_makes_nothing_and_goes_on_once_a_node_shows_again():
    flat = Flat()
    mission = flat.start("teach")
    lead(flat.world, mission, [(1.6, 1.3)])
    before = len(flat.maps.graph.nodes)
    flat.matcher.corner = True
    flat.world.move(0.3, 0.0, 0.0)
    said = mission.decide(flat.world.observe())
    assert "is out of sight, S 0: drive back until it shows" in said.why
    assert [note.kind for note in said.notes] == ["view_fades"]
    assert len(flat.maps.graph.nodes) == before
    flat.matcher.corner = False
    after = lead(flat.world, mission, [(1.1, 2.0)])
    assert flat.false_edges() == []
    assert "node_added" in kinds_of(after)


def test_a_robot_that_is_carried_maps_nothing_before_it_is_at_a_node():
    flat = Flat()
    mission = flat.start("teach")
    lead(flat.world, mission, [(1.1, 1.6), (1.1, 3.2)])
    before = dict(flat.maps.graph.nodes)
    flat.world.pose = (-0.1, -2.4, 1.0)
    said = mission.decide(flat.world.observe())
    assert "another place than a moment ago" in said.why
    elsewhere = lead(flat.world, mission, [(-0.1, -1.7)])
    assert "nothing is taught before the robot is at a node it knows" in elsewhere[-1][1].why
    assert flat.maps.graph.nodes.keys() == before.keys()
    flat.world.pose = flat.maps.poses[0]
    assert "localised" in kinds_of(lead(flat.world, mission, [START[:2]]))
    assert mission.progress.via_points[-1] == 0


def test_driven_again_known_ground_gets_no_second_nodes():
    flat = Flat()
    lead(flat.world, flat.start("teach"), [(1.1, 1.6), (1.1, 3.2)])
    before = len(flat.maps.graph.nodes)
    mission = flat.start("teach", route="back")
    lead(flat.world, mission, [(1.1, 1.6), START[:2]])
    mission.finish()
    assert len(flat.maps.graph.nodes) <= before + 2
    assert flat.away_m(mission.progress.via_points[-1]) < SPOT_M


def test_a_planner_that_takes_over_goes_on_with_the_nodes_passed():
    flat = Flat()
    first = flat.start("teach", route="tour")
    lead(flat.world, first, [(1.1, 1.6)])
    kept = json.loads(json.dumps(first.progress.checkpoint))
    second = flat.start("teach", checkpoint=kept, route="tour")
    lead(flat.world, second, [(1.1, 3.2)])
    passed = second.progress.via_points
    assert passed[: len(kept["passed"])] == tuple(kept["passed"])
    assert len(passed) > len(kept["passed"])


def test_what_others_took_away_meanwhile_is_gone_round():
    flat = Flat()
    mission = flat.start("teach", route="tour")
    lead(flat.world, mission, [(1.1, 1.6)])
    passed = mission.progress.via_points
    flat.maps.commit([DeleteEdge(a=min(passed[:2]), b=max(passed[:2]))])
    mission.finish()
    route = flat.maps.graph.routes["tour"].nodes
    assert all(flat.maps.graph.edge(*leg) is not None for leg in pairwise(route))
    flat.maps.commit([DeleteNode(node_id=passed[0]), PutRoute(route=Route(name="other", nodes=passed[1:]))])
    again = flat.start("teach", checkpoint={"passed": passed}, route="third")
    assert again.progress.via_points[0] == passed[1]
