"""Robots that share tasks on the plan of a generated office, by rights of way or without; gates nothing.

pytest -q -s tests/benchmarks/test_fleet_traffic.py
PLANS=offices-8-small ROBOTS=1,2,4,8 TASKS=40 SEEDS=1,2,3 pytest -q -s tests/benchmarks/test_fleet_traffic.py

Planners, drives and rights of way are the real ones; views follow distance and line of sight
(tests/plane_world.py), and robots are discs that see and hit each other.
"""

import os
from collections import Counter
from dataclasses import asdict

import networkx as nx
import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.rights import Rights
from services.planner.missions.explore import FrontierExploration
from services.planner.profiles import DEFAULT
from simulator.world.freespace import free_space
from tests.benchmarks.test_exploring_plans import world_of
from tests.plane_fleet import Desk, Fleet
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, run

pytestmark = [pytest.mark.slow, pytest.mark.timeout(7200)]

PLANS = os.environ.get("PLANS", "offices-3-medium").split(",")
ROBOTS = [int(count) for count in os.environ.get("ROBOTS", "1,4").split(",")]
SEEDS = [int(seed) for seed in os.environ.get("SEEDS", "1").split(",")]
TASKS = int(os.environ.get("TASKS", "40"))
STEPS_MAX = 20_000


def explored(world, space):
    """The map of one robot that explored the place alone."""
    plane = PlaneWorld((world.start.x_m, world.start.y_m, 0.0), np.random.default_rng(1), space)
    maps = PlaneMap()
    mission = FrontierExploration(DEFAULT, maps, PlaneMatcher(plane, maps), np.random.default_rng(1))
    decision, _ = run(plane, mission, DriveLimits(), STEPS_MAX)
    assert decision.outcome == "succeeded"
    return maps


def far_apart(maps, count):
    """So many nodes, each as far as can be from those before it."""
    graph = Nearness(maps.graph).graph
    ways = dict(nx.all_pairs_dijkstra_path_length(graph))
    chosen = [min(maps.graph.nodes)]
    while len(chosen) < count:
        chosen.append(max(sorted(graph), key=lambda n: min(ways[n].get(one, -1.0) for one in chosen)))
    return chosen


@pytest.mark.parametrize("plan", PLANS)
def test_robots_share_tasks(plan, tmp_path, keep):
    world = world_of(plan, tmp_path)
    space = free_space(world)
    maps = explored(world, space)
    figures = []
    for seed in SEEDS:
        goals = [int(n) for n in np.random.default_rng(seed).choice(sorted(maps.graph.nodes), TASKS)]
        for count in ROBOTS:
            for rights in (Rights(), None) if count > 1 else (Rights(),):
                fleet = Fleet(Desk(maps, rights), space, far_apart(maps, count), seed)
                told = asdict(fleet.play(goals, STEPS_MAX))
                told["ends"] = dict(Counter(told["ends"]))
                figures.append({"seed": seed, "robots": count, "rights": rights is not None, **told})
    keep({"plan": plan, "nodes": len(maps.graph.nodes), "tasks": TASKS, "fleets": figures})
