"""The apartment explored on the true floor plan, once in a run for all tests that begin with its map."""

import fcntl
import pickle
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from services.drive.limits import DriveLimits
from services.planner.missions.explore import FrontierExploration
from services.planner.ports import Decision
from services.planner.profiles import DEFAULT
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, run

START = (2.6, 1.3, 0.0)
MOST_STEPS = 5000


@dataclass(frozen=True)
class Explored:
    """The robot where exploring ended, its map, and how it ended."""

    world: PlaneWorld
    maps: PlaneMap
    decision: Decision


class Explorations:
    """Explored apartments by seed, each a copy of its own; the processes of a run share a folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __call__(self, seed: int) -> Explored:
        """What exploring with a seed comes to."""
        path = self._folder / f"explored-{seed}.pickle"
        with path.with_suffix(".lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not path.exists():
                path.write_bytes(pickle.dumps(_explore(seed)))
        found: Explored = pickle.loads(path.read_bytes())
        return found


def _explore(seed: int) -> Explored:
    world, maps = PlaneWorld(START, np.random.default_rng(seed)), PlaneMap()
    mission = FrontierExploration(DEFAULT, maps, PlaneMatcher(world, maps), np.random.default_rng(seed))
    decision, _ = run(world, mission, DriveLimits(), MOST_STEPS)
    return Explored(world, maps, decision)
