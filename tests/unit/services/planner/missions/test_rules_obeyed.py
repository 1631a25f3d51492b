"""Missions on the true floor plan obey the rules of the map: what is forbidden is not entered."""

import copy
import math
from itertools import pairwise

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.goals.nodes import node_called
from services.planner.mission_kinds import MissionContext, MissionError, mission_kinds
from services.planner.missions.explore import FrontierExploration
from services.planner.missions.goto import Goto
from services.planner.profiles import DEFAULT, THESIS
from shared.mapgraph.frontiers import frontier_sectors, open_directions
from shared.mapgraph.graph import MapGraph
from shared.messages.places import DeleteRule, KeepOut, OneWay, Place, PutPlace, PutRule, Slow
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, picture, run

START = (2.6, 1.3, 0.0)
KEPT_OUT = -7
"""Stands for a node that rule 1 forbids."""
INSIDE_M = 0.35
"""Nearer than this to a forbidden node a robot is in the area: half of the way between two nodes."""


class Flat:
    """A robot in the apartment with a map, and a way to say where it has been."""

    def __init__(self, seed, steps):
        self.world = PlaneWorld(START, np.random.default_rng(seed))
        self.maps, self.seed = PlaneMap(), seed
        self.matcher = PlaneMatcher(self.world, self.maps)
        self.explore(steps)

    def explore(self, steps=5000):
        path = []
        mission = FrontierExploration(DEFAULT, self.maps, self.matcher, np.random.default_rng(self.seed))
        decision, _ = run(self.world, mission, DriveLimits(), steps, path)
        return decision, path

    def goto(self, goal, path):
        mission = Goto(DEFAULT, self.maps, self.matcher, picture(goal))
        return run(self.world, mission, DriveLimits(), 1500, path)[0]

    def forbid(self, roots, size=3):
        """Areas of the nodes around some, but for those beside the robot; the nodes of all."""
        for number, root in enumerate(roots):
            around = self.maps.graph.nearest(int(root), size)
            nodes = [n for n in around if math.dist(self.maps.poses[n][:2], self.world.pose[:2]) > 1.0]
            self.maps.commit([PutPlace(place=Place(name=f"area {number}", nodes=nodes))])
            self.maps.commit([PutRule(rule=KeepOut(name=f"rule {number}", areas=(f"area {number}",)))])
        return set(self.maps.limits().forbidden)

    def furthest(self):
        """The node furthest from the robot."""
        poses = self.maps.poses
        return max(poses, key=lambda n: math.dist(poses[n][:2], self.world.pose[:2]))

    def nearest_m(self, path, nodes):
        """How near a way came to any of some nodes."""
        return min(math.dist(p[:2], self.maps.poses[n][:2]) for p in path for n in nodes)


@pytest.mark.parametrize("seed", [2, 3, 6])
def test_exploration_with_three_areas_enters_none_and_makes_no_node_in_them(seed):
    here = Flat(seed, 100)
    graph, rng = here.maps.graph, np.random.default_rng(seed)
    far = [n for n in graph.nodes if math.dist(here.maps.poses[n][:2], here.world.pose[:2]) > 1.5]
    frontiers = [n for n in far if frontier_sectors(graph.nodes[n])]
    forbidden = here.forbid(rng.choice(frontiers, 3, replace=len(frontiers) < 3))
    before = set(graph.nodes)
    decision, path = here.explore()
    assert decision.outcome == "succeeded", decision.why
    assert here.nearest_m(path, forbidden) > INSIDE_M
    new = [here.maps.poses[n] for n in graph.nodes.keys() - before]
    assert len(new) > 2
    assert here.nearest_m(new, forbidden) > INSIDE_M
    assert open_directions(graph) > 0
    assert "that the rules allow" in decision.why


def test_what_a_lifted_rule_kept_out_of_is_explored_afterwards():
    here = Flat(2, 150)
    graph = here.maps.graph
    frontiers = [n for n in graph.nodes if frontier_sectors(graph.nodes[n])]
    here.maps.commit([PutRule(rule=KeepOut(name="all that is new", nodes=tuple(frontiers)))])
    decision, path = here.explore()
    assert (decision.outcome, path) == ("succeeded", [])
    here.maps.commit([DeleteRule(name="all that is new")])
    before = len(graph.nodes)
    decision, _ = here.explore()
    assert decision.outcome == "succeeded"
    assert "that the rules allow" not in decision.why
    assert len(graph.nodes) > before + 10


@pytest.fixture(scope="module")
def whole():
    """The robot in a whole map, for `free` to copy."""
    return Flat(3, 5000)


@pytest.fixture
def free(whole):
    """A robot with a whole map without rules."""
    here = copy.copy(whole)
    graph = MapGraph(whole.maps.graph.nodes.values(), whole.maps.graph.edges.values())
    here.world, here.maps = PlaneWorld(whole.world.pose, np.random.default_rng(1)), PlaneMap(graph)
    here.maps.poses = dict(whole.maps.poses)
    here.matcher = PlaneMatcher(here.world, here.maps)
    return here


@pytest.fixture
def explored(free):
    """The same with three areas that nobody may enter, and their nodes."""
    return free, free.forbid([4, 17, 30])


def test_goals_are_reached_round_the_areas_or_refused_by_the_name_of_the_rule(explored):
    here, forbidden = explored
    rng, outcomes = np.random.default_rng(7), []
    for _ in range(14):
        goal, path = here.world.space.random_pose(rng, 0.1), [here.world.pose]
        decision = here.goto(goal, path)
        outcomes.append(decision.outcome)
        assert here.nearest_m(path, forbidden) > INSIDE_M
        if decision.outcome == "succeeded":
            assert math.dist(here.world.pose[:2], goal[:2]) < 0.35
        else:
            assert decision.failure == "forbidden", decision.why
            assert "rule 'rule " in decision.why
    assert outcomes.count("succeeded") >= 7


def test_a_picture_taken_in_an_area_is_refused_in_the_first_frame(explored):
    here, forbidden = explored
    for node in sorted(forbidden):
        path = []
        decision = here.goto(here.maps.poses[node], path)
        assert (decision.outcome, decision.failure, path) == ("failed", "forbidden", [])
        rule = here.maps.limits().forbidden[node]
        assert decision.why == f"the goal is forbidden by rule {rule!r}"


def test_a_robot_that_stands_in_an_area_stays_there_and_says_so(explored):
    here, forbidden = explored
    root = here.world.pose = here.maps.poses[17]
    away_m = {n: math.dist(pose[:2], root[:2]) for n, pose in here.maps.poses.items()}
    seen = {n for n in away_m if away_m[n] < 4.0} - forbidden
    here.maps.commit([PutRule(rule=KeepOut(name="all around", nodes=tuple(seen)))])
    path = []
    decision = here.goto(here.maps.poses[max(away_m, key=away_m.__getitem__)], path)
    assert (decision.failure, {p[:2] for p in path}) == ("forbidden", {root[:2]})
    assert "drive the robot by hand, or lift the rule" in decision.why


def test_a_rule_set_while_the_robot_drives_stops_it_before_the_area(free):
    here = free
    goal, path = here.maps.poses[here.furthest()], []
    mission = Goto(DEFAULT, here.maps, here.matcher, picture(goal))
    run(here.world, mission, DriveLimits(), 10, path)
    ahead = mission._travel._follower.position.path
    kept = KeepOut(name="spill", nodes=tuple(n for n in ahead[-3:] if n >= 0))
    here.maps.commit([PutRule(rule=kept)])
    decision, _ = run(here.world, mission, DriveLimits(), 1500, path)
    assert (decision.outcome, decision.failure) == ("failed", "forbidden")
    assert "rule 'spill'" in decision.why
    assert here.nearest_m(path, kept.nodes) > INSIDE_M


def speeds(here, goal):
    """Share of the speed by leg of a goto."""
    found = {}
    mission = Goto(DEFAULT, here.maps, here.matcher, picture(goal))

    class Watched:
        progress = mission.progress

        def decide(self, observation):
            decision = mission.decide(observation)
            follower = mission._travel._follower
            if decision.action == "go" and follower is not None:
                found.setdefault(follower.position.leg, set()).add(round(decision.speed_fraction, 3))
            return decision

    decision, _ = run(here.world, Watched(), DriveLimits(), 1500)
    assert decision.outcome == "succeeded", decision.why
    return found


def test_slow_edges_are_driven_slowly_until_the_rule_is_lifted(free):
    goals = [free.maps.poses[free.furthest()], free.world.pose]
    free.maps.commit([PutRule(rule=Slow(name="wet", edges=tuple(free.maps.graph.edges), speed_share=0.25))])
    for goal, share in zip(goals, (0.25, 1.0), strict=True):
        told = speeds(free, goal)
        edges = {leg: shares for leg, shares in told.items() if min(leg) >= 0 and leg[0] != leg[1]}
        assert len(edges) > 1
        assert all(shares == {share} for shares in edges.values())
        free.maps.commit([DeleteRule(name="wet")] if share < 1.0 else [])


def context_of(here, profile=DEFAULT):
    class Maps(PlaneMap):
        def features_of(self, node_id):
            return picture(self.poses[node_id])

    maps = Maps(here.maps.graph, here.maps.poses)
    return MissionContext(profile, maps, here.matcher, np.random.default_rng(0))


def ruled(here):
    """A node that rule 1 forbids, and the one that is furthest from all that are forbidden."""
    forbidden, poses = here.maps.limits().forbidden, here.maps.poses
    kept_out = min(n for n, rule in forbidden.items() if rule == "rule 1")
    return kept_out, max(poses, key=lambda n: min(math.dist(poses[n][:2], poses[f][:2]) for f in forbidden))


def test_places_are_driven_to_by_name_and_home_is_one(explored):
    here, _ = explored
    home = ruled(here)[1]
    here.maps.commit([PutPlace(place=Place(name="Home", nodes=(home,)))])
    kinds, context = mission_kinds(), context_of(here)
    for kind, parameters in (("home", {}), ("goto", {"place": "HOME"})):
        here.world.pose = here.maps.poses[here.maps.graph.nearest(home, 9)[-1]]
        decision, _ = run(here.world, kinds[kind].start(context, parameters), DriveLimits(), 1500)
        assert decision.outcome == "succeeded", decision.why
        assert math.dist(here.world.pose[:2], here.maps.poses[home][:2]) < 0.35


@pytest.mark.parametrize(
    ("kind", "parameters", "words", "code"),
    [
        ("goto", {"place": "Hom"}, "no place 'Hom'; nearest: 'Home'", "missing"),
        ("goto", {"place": "area 1"}, "place 'area 1' is forbidden by rule 'rule 1'", "forbidden"),
        ("goto", {"goal_node": KEPT_OUT}, "node {} is forbidden by rule 'rule 1'", "forbidden"),
        ("goto", {"place": "a\nb"}, "control characters", "invalid"),
        ("goto", {"place": "home", "goal_node": 3}, "exactly one of them", "invalid"),
        ("goto", {"place": "empty"}, "has no nodes left", "missing"),
    ],
)
def test_what_cannot_be_driven_to_is_refused_at_once(explored, kind, parameters, words, code):
    here, _ = explored
    kept_out, home = ruled(here)
    marks = [Place(name="Home", nodes=(home,)), Place(name="empty")]
    here.maps.commit([PutPlace(place=place) for place in marks])
    parameters = {k: kept_out if v == KEPT_OUT else v for k, v in parameters.items()}
    with pytest.raises(MissionError, match=words.format(kept_out)) as refused:
        mission_kinds()[kind].start(context_of(here), parameters)
    assert refused.value.code == code


def test_without_a_place_called_home_the_mission_says_how_to_name_one():
    here = Flat(2, 20)
    with pytest.raises(MissionError, match="topnav place name home") as refused:
        mission_kinds()["home"].start(context_of(here), {})
    assert refused.value.code == "missing"


def test_of_an_area_the_first_node_that_is_allowed_is_driven_to(explored):
    here, _ = explored
    kept_out, allowed = ruled(here)
    here.maps.commit([PutPlace(place=Place(name="half", nodes=(kept_out, allowed, 3)))])
    assert node_called(here.maps, "half") == allowed


def test_random_exploration_does_not_start_where_something_is_forbidden(explored):
    here, _ = explored
    with pytest.raises(MissionError, match="explores at random") as refused:
        mission_kinds()["explore"].start(context_of(here, THESIS), {})
    assert refused.value.code == "forbidden"


def test_one_way_edges_are_not_driven_against(free):
    here = free
    graph = here.maps.graph
    goal = here.maps.poses[9]
    mission = Goto(DEFAULT, here.maps, here.matcher, picture(goal))
    run(here.world, mission, DriveLimits(), 2)
    path = [n for n in mission._travel._follower.position.path if n >= 0]
    against = tuple((b, a) for a, b in pairwise(path))
    here.maps.commit([PutRule(rule=OneWay(name="lane", edges=against))])
    decision, _ = run(here.world, mission, DriveLimits(), 1)
    after = [n for n in mission._travel._follower.position.path if n >= 0]
    assert set(pairwise(after)).isdisjoint(pairwise(path))
    assert all(edge in graph.edges for edge in ((min(e), max(e)) for e in pairwise(after)))
    assert decision.outcome == ""
