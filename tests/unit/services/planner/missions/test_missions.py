"""Missions on the true floor plan: maps grow until nothing is open, goals are reached, refusals are typed."""

import math

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.mapping.strategies import ThesisExploration
from services.planner.missions.explore import FrontierExploration
from services.planner.missions.goto import Goto
from services.planner.profiles import DEFAULT, THESIS
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, picture, run

START = (2.6, 1.3, 0.0)


@pytest.fixture(scope="module")
def explored(explorations):
    found = explorations(2)
    return found.world, found.maps, PlaneMatcher(found.world, found.maps), found.decision


def test_exploration_ends_by_itself_with_one_map_of_the_whole_floor(explored):
    world, maps, _, decision = explored
    centres = world.space.centres_m()
    nodes = np.array([pose[:2] for pose in maps.poses.values()])
    distance_m = np.hypot(*(centres[:, None, :] - nodes[None, :, :]).transpose(2, 0, 1)).min(axis=1)
    assert decision.outcome == "succeeded"
    assert maps.graph.components() == 1
    assert (distance_m < 1.0).mean() >= 0.9
    assert world.collisions == 0


def test_stored_headings_point_to_the_neighbour_from_both_ends(explored):
    _, maps, _, _ = explored
    errors = []
    for (a, b), edge in maps.graph.edges.items():
        for near, far, heading in ((a, b, edge.heading_ab_rad), (b, a, edge.heading_ba_rad)):
            here, there = maps.poses[near], maps.poses[far]
            true = math.atan2(there[1] - here[1], there[0] - here[0]) - here[2]
            errors.append(abs(math.remainder(heading - true, math.tau)))
    assert np.median(errors) < math.radians(1.0)


def test_goals_anywhere_in_the_map_are_reached_without_collision(explored):
    world, maps, matcher, _ = explored
    rng = np.random.default_rng(5)
    for _ in range(6):
        goal = world.space.random_pose(rng, 0.1)
        decision, _ = run(world, Goto(DEFAULT, maps, matcher, picture(goal)), DriveLimits(), 1500)
        assert decision.outcome == "succeeded", decision.why
        assert math.dist(world.pose[:2], goal[:2]) < 0.35
    assert world.collisions == 0


def test_goal_that_resembles_nothing_is_refused_by_name(explored):
    world, maps, matcher, _ = explored
    mission = Goto(DEFAULT, maps, matcher, picture((40.0, 40.0, 0.0)))
    decision = mission.decide(world.observe())
    assert (decision.outcome, decision.failure) == ("failed", "goal_not_in_map")


def test_kidnapped_robot_finds_the_goal_all_the_same(explored):
    world, maps, matcher, _ = explored
    goal = (6.0, 2.0, 1.0)
    mission = Goto(DEFAULT, maps, matcher, picture(goal))
    world.pose = (-0.2, -2.5, 0.0)
    run(world, mission, DriveLimits(), 8)
    world.pose = (1.0, 2.5, 0.0)
    decision, _ = run(world, mission, DriveLimits(), 800)
    assert decision.outcome == "succeeded", decision.why


def test_same_seed_gives_the_same_map():
    def fingerprint():
        world = PlaneWorld(START, np.random.default_rng(4))
        maps = PlaneMap()
        mission = FrontierExploration(DEFAULT, maps, PlaneMatcher(world, maps), np.random.default_rng(4))
        run(world, mission, DriveLimits(), 200)
        return world.pose, sorted(maps.graph.edges), sorted(maps.graph.nodes)

    assert fingerprint() == fingerprint()


def test_first_heading_is_random_by_seed():
    def first(seed):
        world, maps = PlaneWorld(START, np.random.default_rng(0)), PlaneMap()
        rng = np.random.default_rng(seed)
        mission = ThesisExploration(THESIS, maps, PlaneMatcher(world, maps), rng)
        return mission.decide(world.observe()).heading_rad

    assert first(1) == first(1)
    assert first(1) != first(2)


def test_thesis_strategies_grow_a_map_and_never_forget_the_first_place():
    world, maps = PlaneWorld(START, np.random.default_rng(3)), PlaneMap()
    mission = ThesisExploration(THESIS, maps, PlaneMatcher(world, maps), np.random.default_rng(3))
    run(world, mission, DriveLimits(avoidance="momentary"), 400)
    assert len(maps.graph.nodes) >= 5
    assert 0 in maps.graph.nodes
    assert all(
        edge.inliers + edge.raw_matches > THESIS.mapping.s_edge_min for edge in maps.graph.edges.values()
    )
