"""Metres of exploring the floor plans of development worlds, beside a metric peer; gates nothing.

pytest -q -s tests/benchmarks/test_exploring_plans.py
PLANS=hostel-0-medium,apartment SEEDS=1,2 pytest -q -s tests/benchmarks/test_exploring_plans.py
CARRIES=1.6 PLANS=school-15-small pytest -q -s tests/benchmarks/test_exploring_plans.py  # as in a bare hall
CARRIES=1.6 PLANS=yard-3-small pytest -q -s tests/benchmarks/test_exploring_plans.py  # outdoors

Views follow distance and line of sight (tests/plane_world.py) and nothing is rendered: a world takes seconds,
so that ways of exploring can be compared on many. What is chosen here is judged on rendered worlds later.
"""

import os

import numpy as np
import pytest

from experiments.generated.peers import frontier_curve
from experiments.generated.plan import COVERED
from experiments.generated.row import RANGE, RANGE_M
from services.drive.limits import DriveLimits
from services.launcher.client.environments import environment_of
from services.launcher.evaluation.coverage_curve import metres_to
from services.planner.missions.explore import FrontierExploration
from services.planner.profiles import DEFAULT
from simulator.generation.generate import generate
from simulator.generation.splits import split_of
from simulator.generation.world_text import write_world
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, run

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

PLANS = (
    "apartment,flat-9-small,flat-12-small,hotel-1-small,hotel-4-small,offices-3-medium,hostel-0-medium,"
    "school-0-small,school-15-small,shop-2-small"
)
STEPS_MAX = 12_000


class Watched:
    """An exploration, with the metres driven at each new node and those of leaving nodes."""

    def __init__(self, plane, maps, mission):
        self.plane, self.maps, self.mission = plane, maps, mission
        self.node_m, self.left_m, self._last_m, self._leaving = [], 0.0, 0.0, False

    @property
    def progress(self):
        return self.mission.progress

    def decide(self, observation):
        driven_m = self.plane.driven_m
        self.left_m += (driven_m - self._last_m) * self._leaving
        decision = self.mission.decide(observation)
        self._last_m, self._leaving = driven_m, decision.method == "frontier"
        self.node_m += [driven_m] * (len(self.maps.poses) - len(self.node_m))
        return decision


def world_of(name, folder):
    """A world that ships with topnav, or a generated one of the development split."""
    if "-" not in name:
        return load_world(name)
    kind, seed, size = name.rsplit("-", 2)
    assert split_of(kind, int(seed)) == "development", f"{name} is kept back to judge"
    write_world(folder / f"{name}.yaml", generate(kind, int(seed), size))
    return load_world(str(folder / f"{name}.yaml"))


def curve_of(space, watched, covers_m):
    """Driven metres and covered share of the floor after each node."""
    floor, curve = space.centres_m(), []
    uncovered = np.ones(len(floor), bool)
    for driven_m, pose in zip(watched.node_m, watched.maps.poses.values(), strict=True):
        uncovered &= np.linalg.norm(floor - np.array(pose[:2]), axis=1) > covers_m
        curve.append((driven_m, 1.0 - float(uncovered.mean())))
    return curve


@pytest.mark.parametrize("seed", [int(seed) for seed in os.environ.get("SEEDS", "1").split(",")])
@pytest.mark.parametrize("name", os.environ.get("PLANS", PLANS).split(","))
def test_metres_on_a_floor_plan(name, seed, tmp_path, keep):
    world = world_of(name, tmp_path)
    space, start = free_space(world), world.start
    place = environment_of(world)
    range_m = float(place.variables.get(RANGE, RANGE_M))
    here, rng = (start.x_m, start.y_m, 0.0), np.random.default_rng(seed)
    plane, maps = PlaneWorld(here, rng, space, max_range_m=range_m), PlaneMap()
    matcher = PlaneMatcher(plane, maps, carries=float(os.environ.get("CARRIES", "1")))
    told = DEFAULT.replaced(covers_m=place.covered_m)
    mission = FrontierExploration(told, maps, matcher, np.random.default_rng(seed))
    watched = Watched(plane, maps, mission)
    decision, _ = run(plane, watched, DriveLimits(), STEPS_MAX)
    curve = curve_of(space, watched, place.covered_m)
    peer = frontier_curve(space, (start.x_m, start.y_m), place.covered_m, range_m, COVERED)
    keep(
        {
            "ended": decision.outcome,
            "coverage": curve[-1][1],
            "nodes": len(curve),
            "driven_m": plane.driven_m,
            "leaving_m": watched.left_m,
            "to_97_m": metres_to(curve, COVERED),
            "peer_m": metres_to(peer, COVERED),
            "collisions": plane.collisions,
        }
    )
