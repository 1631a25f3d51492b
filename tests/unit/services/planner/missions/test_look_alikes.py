"""Where desks repeat no edge leads a period further, and a goal that repeats is told apart or named."""

import copy
import math
from types import SimpleNamespace

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.goals.destination import GoalDestination
from services.planner.missions.explore import FrontierExploration
from services.planner.missions.goto import Goto
from services.planner.profiles import DEFAULT, THESIS
from services.planner.travel.destination import Setback
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.states import Event
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import GOAL
from shared.messages.matching import DIFFERENCES_SHAPE, NodeMatch
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, picture, run

START = (2.0, 1.3, 0.0)
PERIOD_M = 4.8
STEPS = 500


@pytest.fixture(scope="module")
def as_explored():
    """An office as a robot explored it; tests change copies of it."""
    space = free_space(load_world("office"))
    world = PlaneWorld(START, np.random.default_rng(3), space)
    maps = PlaneMap()
    matcher = PlaneMatcher(world, maps, PERIOD_M)
    where = Whereabouts("office")
    mission = FrontierExploration(DEFAULT, maps, matcher, np.random.default_rng(3), where)
    run(world, mission, DriveLimits(), STEPS)
    return world, maps, matcher, where


@pytest.fixture(scope="module")
def explored(as_explored):
    return copy.deepcopy(as_explored)


def bearing(here, there):
    return math.atan2(there[1] - here[1], there[0] - here[0]) - here[2]


def test_no_edge_leads_a_period_further(explored):
    _, maps, _, _ = explored
    edges = maps.graph.edges.values()
    errors = [abs(math.remainder(e.heading_ab_rad - bearing(maps.poses[e.a], maps.poses[e.b]), math.tau))
              for e in edges if e.heading_ab_rad is not None]  # fmt: skip
    longest_m = max(math.dist(maps.poses[e.a][:2], maps.poses[e.b][:2]) for e in edges)
    spread_m = max(pose[0] for pose in maps.poses.values()) - min(pose[0] for pose in maps.poses.values())
    assert spread_m > 1.5 * PERIOD_M
    assert len(errors) > 100
    assert longest_m < 0.8 * PERIOD_M
    assert np.mean(np.array(errors) < math.radians(20.0)) > 0.985  # of all sights here 2 % point anywhere


def test_driven_edges_are_as_long_as_the_robot_drove(explored):
    _, maps, _, _ = explored
    driven = [edge for edge in maps.graph.edges.values() if edge.length_m]
    true_m = [math.dist(maps.poses[e.a][:2], maps.poses[e.b][:2]) for e in driven]
    assert len(driven) >= len(maps.poses) // 2
    assert np.median([e.length_m / m for e, m in zip(driven, true_m, strict=True)]) == pytest.approx(
        1.0, abs=0.1
    )


def test_a_goal_that_looks_like_another_spot_is_reached_or_named_ambiguous(explored):
    world, maps, matcher, where = explored
    goal = max(maps.poses.values(), key=lambda pose: pose[0])
    decision, _ = run(world, Goto(DEFAULT, maps, matcher, picture(goal), where), DriveLimits(), 1500)
    arrived = decision.outcome == "succeeded" and math.dist(world.pose[:2], goal[:2]) < 0.5
    assert arrived or decision.failure == "ambiguous", decision.why


def test_an_arrival_that_was_refuted_excludes_no_place_that_the_way_led_by(explored):
    """The last node of the way may belong to another place than the spot where the robot stood."""
    _, maps, matcher, _ = explored
    experience = EdgeExperience(DEFAULT, maps)
    places = (
        GoalDestination(DEFAULT, maps, matcher, picture(pose), experience, Whereabouts())
        for pose in maps.poses.values()
    )
    goal = next(place for place in places if place.aliased)
    before = set(goal.targets())
    for node in before:
        for _ in range(3):
            goal.setback(Setback(Event.ALIASED, None, GOAL, (node, GOAL), "aliased"))
    assert set(goal.targets()) == before


def doubtful_nodes(maps, matcher):
    experience = EdgeExperience(DEFAULT, maps)
    for node, pose in maps.poses.items():
        found = GoalDestination(DEFAULT, maps, matcher, picture(pose), experience, Whereabouts())
        if found.aliased:
            yield node


@pytest.mark.parametrize("knows_where_it_is", [True, False])
def test_a_node_of_the_map_is_driven_to_by_the_map_by_who_knows_where_it_is(explored, knows_where_it_is):
    """Its picture alone would have the robot look at every spot that looks like it."""
    world, maps, matcher, where = explored
    node = max(doubtful_nodes(maps, matcher), key=lambda n: math.dist(maps.poses[n][:2], world.pose[:2]))
    if not knows_where_it_is:
        where = Whereabouts("office", where.here, guessed=True, now=where.now, before=where.before)
    mission = Goto(DEFAULT, maps, matcher, picture(maps.poses[node]), where, node)
    first = mission.decide(world.observe())
    told = [note.reason for note in first.notes if note.kind == "goal_located"]
    decision, _ = run(world, mission, DriveLimits(), 1500)
    assert told[0] == f"goal is node {node}"
    assert [text[:14] for text in told[1:]] == ([] if knows_where_it_is else ["goal resembles"])
    arrived = decision.outcome == "succeeded" and math.dist(world.pose[:2], maps.poses[node][:2]) < 0.5
    assert arrived or (decision.failure == "ambiguous" and not knows_where_it_is), decision.why


@pytest.mark.parametrize(
    ("profile", "gone", "told", "aliased"),
    [
        (DEFAULT, False, "goal is node", True),
        (DEFAULT, True, "goal resembles nodes", None),
        (THESIS, False, "goal is node", False),
    ],
)
def test_look_alikes_of_a_node_are_not_known_unless_it_is_gone(explored, profile, gone, told, aliased):
    """By the thesis's strict rules nothing is said of them."""
    _, maps, matcher, _ = explored
    node, pose = next(iter(maps.poses.items()))
    experience, where = EdgeExperience(profile, maps), Whereabouts()
    node = max(maps.poses) + 1 if gone else node
    goal = GoalDestination(profile, maps, matcher, picture(pose), experience, where, node)
    assert goal.located().reason.startswith(told)
    assert aliased is None or goal.aliased == aliased


def test_another_look_at_a_place_in_doubt_is_from_nearer_by(explored):
    _, maps, matcher, where = explored
    node = next(doubtful_nodes(maps, matcher))
    experience = EdgeExperience(DEFAULT, maps)
    goal = GoalDestination(DEFAULT, maps, matcher, picture(maps.poses[node]), experience, where)
    before_rad = goal.arrival_rad
    for differs, place in enumerate(map(int, goal.candidates.names.split(", ")), start=20):
        assert goal.arrival_rad == before_rad
        tracker = SimpleNamespace(here=Displacement(place), likeness=lambda _: 0.9)
        goal.sees(
            NodeMatch(
                node_id=GOAL,
                status="ok",
                raw_matches=300,
                inliers=300,
                differences=np.full(DIFFERENCES_SHAPE, differs, np.float32),
            ),
            tracker.here,
        )
        assert goal.refutes_arrival(place, 1000, tracker)
    assert goal.places.looks_again
    assert 0.0 < goal.arrival_rad < before_rad


def test_a_look_alike_that_no_way_leads_to_is_given_up_for_the_others(explored):
    """A bed stands on its spot, say: elsewhere the mission's patience begins anew."""
    _, maps, matcher, _ = explored
    node = next(doubtful_nodes(maps, matcher))
    experience = EdgeExperience(DEFAULT, maps)
    goal = GoalDestination(DEFAULT, maps, matcher, picture(maps.poses[node]), experience, Whereabouts())
    first, *others = map(int, goal.candidates.names.split(", "))
    assert first in goal.targets()

    def stuck(waypoint):
        return goal.setback(Setback(Event.NO_PROGRESS, None, waypoint, (waypoint, GOAL), "no progress"))

    verdicts = [stuck(waypoint) for waypoint in [first] * 4 + [max(maps.poses) + 1] * 7]
    assert {verdict.failure for verdict in verdicts} == {""}
    assert [note.kind for note in verdicts[3].notes] == ["replan", "place_shut"]
    assert first not in goal.targets()
    assert not goal.targets().keys().isdisjoint(others)


def noticed_and_arrived(explored, node, believed, seed):
    """Whether a robot at a node that believes to be at another notices it, and comes to the furthest node."""
    explored_world, maps, _, _ = explored
    world = PlaneWorld(maps.poses[node], np.random.default_rng(seed), explored_world.space)
    matcher = PlaneMatcher(world, maps, PERIOD_M)
    goal = max(maps.poses.values(), key=lambda pose: math.dist(pose[:2], world.pose[:2]))
    mission = Goto(DEFAULT, maps, matcher, picture(goal), Whereabouts("office"))
    run(world, mission, DriveLimits(), 1)
    mission._travel.tracker.stand_at(Displacement(believed, spread_m=0.1))
    kinds = set()
    for _ in range(STEPS):
        decision, _ = run(world, mission, DriveLimits(), 1)
        kinds |= {note.kind for note in decision.notes}
        if decision.outcome:
            break
    return (
        "mistaken" in kinds and decision.outcome == "succeeded" and math.dist(world.pose[:2], goal[:2]) < 0.5
    )


def test_who_believes_to_be_at_a_look_alike_notices_it_on_the_way(as_explored, monkeypatch):
    """The true places show better; not on every way: some lead along nothing but look-alikes at first."""
    monkeypatch.setattr("tests.plane_world.ALIKE", 0.25)
    poses = as_explored[1].poses
    alike = [(a, b) for a, p in poses.items() for b, q in poses.items()
             if math.dist((p[0] + PERIOD_M, p[1]), q[:2]) < 0.25]  # fmt: skip
    ways = [(node, believed, seed) for node, believed in alike[:8:2] for seed in (0, 5)]
    found = {way: noticed_and_arrived(copy.deepcopy(as_explored), *way) for way in ways}
    assert len(ways) == 8
    assert sum(found.values()) >= 7, found
