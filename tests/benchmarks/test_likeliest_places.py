"""Which of the places that look alike is the likeliest, by matches and by pictures of nodes; gates nothing.

SUITE=runs/dev WORLDS=hotel-1-small,hostel-0-small pytest -q -s tests/benchmarks/test_likeliest_places.py

SUITE is what `topnav suite generated --data-dir SUITE` keeps of its worlds: their files, maps and true poses.
Goal pictures are rendered up to half a metre from nodes (decision 0033).
"""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from experiments.rendered.frames import tilting_camera
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.goals.candidates import Candidates
from services.planner.profiles import DEFAULT
from shared.mapgraph.local.hypotheses import COMPARED_NODES
from shared.messages.simulation import Pose
from simulator.sensors.attitude import LEVEL
from simulator.world.world_file import load_world
from tests.benchmarks.played_world import PlayedWorld
from tests.unit.services.planner.travel.seen import Maps

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

WORLDS = [name for name in os.environ.get("WORLDS", "").split(",") if name]
GOALS, BESIDE_M, ITS_OWN_M = 60, (0.1, 0.5), 1.0


def is_right(world, place, goal):
    return any(math.dist(goal, (world.poses[n].x_m, world.poses[n].y_m)) < ITS_OWN_M for n in place.nodes)


@pytest.mark.parametrize("name", WORLDS)
def test_how_often_the_likeliest_place_is_the_goals(name, keep):
    folder, pipeline = Path(os.environ["SUITE"]) / name, Pipeline(find_profile("sift"))
    played, rng = PlayedWorld(folder, name, pipeline), np.random.default_rng(1)
    camera = tilting_camera(load_world(str(folder / f"{name}.yaml")))
    figures = {"goals": 0, "places": 0, "by_matches": 0, "by_pictures": 0, "unlikely": 0, "unlikely_right": 0}
    for _ in range(int(os.environ.get("GOALS", GOALS))):
        node = played.poses[int(rng.choice(sorted(played.poses)))]
        angle, far_m = rng.uniform(0.0, math.tau), rng.uniform(*BESIDE_M)
        at = node.x_m + far_m * math.cos(angle), node.y_m + far_m * math.sin(angle)
        goal = pipeline.features_of(camera(Pose(x_m=at[0], y_m=at[1], yaw_rad=rng.uniform(-3.0, 3.0)), LEVEL))
        candidates = Candidates(Maps(played.graph), played.found(goal, best_k=COMPARED_NODES), DEFAULT)
        if candidates.plain or len(candidates.places) < 2:
            continue
        figures["goals"] += 1
        figures["places"] += len(candidates.places)
        figures["by_matches"] += is_right(played, candidates.places[0], at)
        candidates.look(played.found(goal, candidates.to_look_at()))
        figures["by_pictures"] += is_right(played, candidates.places[0], at)
        figures["unlikely"] += len(candidates.unlikely)
        figures["unlikely_right"] += sum(is_right(played, place, at) for place in candidates.unlikely)
    keep(figures)
