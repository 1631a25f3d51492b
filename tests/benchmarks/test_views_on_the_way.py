"""How often a view on a way speaks against where the robot truly is; gates nothing.

SUITE=runs/dev WORLDS=hotel-1-small,hostel-0-small pytest -q -s tests/benchmarks/test_views_on_the_way.py

SUITE is what `topnav suite generated --data-dir SUITE` keeps of its worlds. WAYS shortest ways through each,
20 by default, between nodes drawn by chance, after furniture was moved, or with MOVED=0 before that:
a robot that knows where it is compares every view with the whole map (services/planner/travel/doubts.py).
"""

import os
from pathlib import Path

import numpy as np
import pytest

from experiments.rendered.frames import tilting_camera
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from services.planner.travel import doubts
from services.planner.travel.doubts import LOOK_AROUND_M
from services.planner.travel.tracking import COMPARED, Tracker
from shared.messages.sensors import Ranges
from simulator.sensors.attitude import LEVEL
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.benchmarks.played_world import PlayedWorld
from tests.benchmarks.ways_through import about, poses_along
from tests.unit.services.planner.travel.seen import Maps, Matcher, features

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

WORLDS = [name for name in os.environ.get("WORLDS", "").split(",") if name]
WHEN = "" if os.environ.get("MOVED", "1") == "0" else "-rearranged"
WAYS, SPREAD_M = 20, 0.3
RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(4.0,) * 12, max_range_m=4.0)


@pytest.mark.parametrize("name", WORLDS)
def test_how_often_a_view_speaks_against_where_the_robot_is(name, keep, monkeypatch):
    monkeypatch.setattr(doubts, "DOUBTS", 1)
    folder, pipeline = Path(os.environ["SUITE"]) / name, Pipeline(find_profile("sift"))
    played, rng = PlayedWorld(folder, name, pipeline), np.random.default_rng(5)
    world = load_world(str(folder / f"{name}{WHEN}.yaml"))
    camera, free = tilting_camera(world), free_space(world)
    figures = {"ways": int(os.environ.get("WAYS", WAYS)), "views": 0, "against": 0}
    for _ in range(figures["ways"]):
        for pose in poses_along(played, free, rng, LOOK_AROUND_M):
            tracker = Tracker(DEFAULT, Maps(played.graph), Matcher(), certain=False)
            tracker.observe(Observation(features(), RANGES))
            tracker.stand_at(about(played, pose, SPREAD_M))
            view = pipeline.features_of(camera(pose, LEVEL))
            tracker.possible(played.found(view, tracker.nearby(), COMPARED), of_map=True)
            figures["views"] += 1
            figures["against"] += tracker.mistaken
    keep(figures)
