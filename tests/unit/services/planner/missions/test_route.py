"""Driving along a route on the true floor plan: exactly its nodes, there and back, round what is blocked."""

import copy
import json
import math

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.mission_kinds import MissionContext, MissionError, mission_kinds
from services.planner.profiles import DEFAULT
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import DeleteEdge
from shared.messages.places import KeepOut, OneWay, PutRoute, PutRule, Route
from simulator.scene.parts import Material
from simulator.scene.shapes import post
from tests.plane_person import lead
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, run

START = (2.6, 1.3, 0.0)
LOOP = ((1.1, 3.2), (2.2, 5.2), (4.6, 5.2), (4.55, 3.0), (4.0, 1.3), START[:2])
AT_M = 0.55
"""Who passed a node came as near: `travel_arrival_rad` stands for 0.4 m."""


class Taught:
    """A robot at the beginning of a loop that was taught, and what is seen of it on its way."""

    def __init__(self):
        self.world, self.maps = PlaneWorld(START, np.random.default_rng(1)), PlaneMap()
        self.matcher = PlaneMatcher(self.world, self.maps)
        teach = self.start("teach", route="tour")
        lead(self.world, teach, LOOP)
        teach.finish()
        self.nodes = self.maps.graph.routes["tour"].nodes

    def again(self):
        """The same, before it drove anywhere."""
        one, graph = copy.copy(self), self.maps.graph
        one.world = PlaneWorld(START, np.random.default_rng(2), space=self.world.space)
        kept = MapGraph(graph.nodes.values(), graph.edges.values(), routes=graph.routes.values())
        one.maps = PlaneMap(kept, dict(self.maps.poses))
        one.matcher = PlaneMatcher(one.world, one.maps)
        return one

    def start(self, kind="route", checkpoint=None, **parameters):
        context = MissionContext(
            DEFAULT, self.maps, self.matcher, np.random.default_rng(0), checkpoint=checkpoint or {}
        )
        return mission_kinds()[kind].start(context, parameters)

    def drive(self, mission, steps=2000):
        """The last decision, all notes, and the way."""
        watched, path = Watched(mission), []
        decision, _ = run(self.world, watched, DriveLimits(), steps, path)
        return decision, watched.notes, path

    def passed(self, path, nodes):
        """How many of some nodes the way came to in their order."""
        count = 0
        for pose in path:
            while count < len(nodes) and math.dist(pose[:2], self.maps.poses[nodes[count]][:2]) < AT_M:
                count += 1
        return count

    def away_m(self, node):
        return math.dist(self.maps.poses[node][:2], self.world.pose[:2])


class Watched:
    """A mission with its notes."""

    def __init__(self, mission):
        self.mission, self.notes = mission, []

    @property
    def progress(self):
        return self.mission.progress

    def decide(self, observation):
        decision = self.mission.decide(observation)
        self.notes += decision.notes
        return decision


@pytest.fixture(scope="module")
def taught():
    return Taught()


@pytest.fixture
def flat(taught):
    return taught.again()


def test_it_follows_exactly_the_nodes_though_it_stands_at_the_end_of_the_loop(flat):
    decision, _, path = flat.drive(flat.start(route="Tour"))
    assert (decision.outcome, decision.why) == ("succeeded", "route 'Tour' driven, rounds: 1")
    assert flat.passed(path, flat.nodes) == len(flat.nodes)
    assert flat.away_m(flat.nodes[-1]) < 0.15


def test_backwards_it_follows_them_in_the_other_order_and_ends_where_it_was_begun(flat):
    part = flat.nodes[: len(flat.nodes) // 2]
    flat.maps.commit([PutRoute(route=Route(name="part", nodes=part))])
    decision, _, path = flat.drive(flat.start(route="part", reverse=True))
    assert decision.outcome == "succeeded", decision.why
    assert flat.passed(path, part[::-1]) == len(part)
    assert flat.away_m(part[0]) < 0.15


def test_it_goes_as_many_rounds_as_it_is_told(flat):
    part = flat.nodes[:4]
    flat.maps.commit([PutRoute(route=Route(name="part", nodes=part))])
    decision, notes, path = flat.drive(flat.start(route="part", rounds=2))
    assert (decision.outcome, decision.why) == ("succeeded", "route 'part' driven, rounds: 2")
    assert flat.passed(path, part * 2) == 2 * len(part)
    assert [note.values["round"] for note in notes if note.kind == "round_driven"] == [1, 2]


def test_a_planner_that_takes_over_goes_on_with_the_node_under_way(flat):
    first = flat.start(route="tour")
    while first.progress.figures["passed"] < 5:
        flat.drive(first, 1)
    kept = json.loads(json.dumps(first.progress.checkpoint))
    decision, _, path = flat.drive(flat.start(checkpoint=kept, route="tour"))
    assert decision.outcome == "succeeded", decision.why
    assert flat.passed(path, flat.nodes[kept["at"] :]) == len(flat.nodes) - kept["at"]
    assert min(math.dist(pose[:2], flat.maps.poses[flat.nodes[2]][:2]) for pose in path) > AT_M


def test_what_is_blocked_is_gone_round_to_the_next_node_and_told(flat):
    """A door in the west shuts: the loop leads there from the other side as well."""
    shut_x, shut_y = (1.1, 2.6)
    before = flat.world.space
    for offset in (-0.4, 0.0, 0.4):
        flat.world.put(post(shut_x + offset, shut_y, (0.0, 1.0), 0.2, Material("lacquer")))
    decision, notes, _ = flat.drive(flat.start(route="tour"))
    flat.world.take_away(before)
    assert decision.outcome == "succeeded", decision.why
    kinds = {note.kind for note in notes}
    assert kinds & {"goes_round", "left_out"}
    assert flat.away_m(flat.nodes[-1]) < 0.3


def rule_of(flat, kind):
    a, b = flat.nodes[2:4]
    return {
        "keep_out": KeepOut(name="wet floor", nodes=(a,)),
        "one_way": OneWay(name="wet floor", edges=((b, a),)),
    }[kind]


@pytest.mark.parametrize("kind", ["keep_out", "one_way"])
def test_a_rule_against_it_refuses_it_by_name_at_once_and_on_the_way(flat, kind):
    under_way = flat.start(route="tour")
    flat.drive(under_way, 3)
    flat.maps.commit([PutRule(rule=rule_of(flat, kind))])
    with pytest.raises(MissionError, match="route 'tour' is forbidden by rule 'wet floor'") as refused:
        flat.start(route="tour")
    assert refused.value.code == "forbidden"
    decision, _, _ = flat.drive(under_way, 2)
    assert (decision.outcome, decision.failure) == ("failed", "forbidden")
    assert "rule 'wet floor' is against going on along route 'tour'" in decision.why


def test_a_one_way_edge_is_driven_the_way_it_leads(flat):
    flat.maps.commit([PutRule(rule=rule_of(flat, "one_way"))])
    assert flat.start(route="tour", reverse=True)


def test_a_broken_route_and_one_that_is_not_there_are_refused_with_what_to_do(flat):
    a, b = sorted(flat.nodes[:2])
    flat.maps.commit([DeleteEdge(a=a, b=b)])
    with pytest.raises(
        MissionError, match=f"broken: no edge joins nodes {a} and {b} any more; teach it anew"
    ):
        flat.start(route="tour")
    with pytest.raises(MissionError, match="no route 'toor'; nearest: 'tour'"):
        flat.start(route="toor")
