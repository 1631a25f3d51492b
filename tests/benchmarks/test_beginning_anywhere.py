"""How far a robot drives that takes one place for another which looks alike; gates nothing.

SUITE=runs/dev WORLDS=hotel-1-small,hostel-0-small pytest -q -s tests/benchmarks/test_beginning_anywhere.py

SUITE is what `topnav suite generated --data-dir SUITE` keeps of its worlds. WAYS ways through each, 20 by
default, with the furniture as it was mapped, or with MOVED=1 after it was moved: a robot that does not know
where it begins takes the likeliest place, goes on and learns (services/planner/travel/tracking.py).
"""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from experiments.rendered.frames import tilting_camera
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from services.planner.travel.tracking import COMPARED, Tracker
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION, rotated
from simulator.sensors.attitude import LEVEL
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.benchmarks.played_world import PlayedWorld
from tests.benchmarks.ways_through import moved, poses_along
from tests.unit.services.planner.travel.seen import Maps

pytestmark = [pytest.mark.slow, pytest.mark.timeout(7200)]

WORLDS = [name for name in os.environ.get("WORLDS", "").split(",") if name]
WHEN = "-rearranged" if os.environ.get("MOVED") == "1" else ""
WAYS, STEP_M = 20, 0.33
SIGNS = {None: "?", True: "x", False: "."}
WRONG_M, WRONG_RAD = 1.5, math.radians(45.0)
RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(4.0,) * 12, max_range_m=4.0)


class Eyes:
    """Compares the frame that a robot sees with its map."""

    def __init__(self, played):
        self._played, self.view = played, None

    def match(self, node_ids, best_k=0, targets=()):
        return self._played.found(self.view, node_ids, best_k, targets)


def is_wrong(played, here, pose):
    """Whether a robot is elsewhere than it believes; None where it believes nothing."""
    if here is None:
        return None
    node = played.poses[here.node_id]
    x_m, y_m = rotated(here.x_m, here.y_m, node.yaw_rad)
    away_m = math.dist((node.x_m + x_m, node.y_m + y_m), (pose.x_m, pose.y_m))
    turned_rad = abs(math.remainder(node.yaw_rad + here.yaw_rad - pose.yaw_rad, math.tau))
    return away_m > WRONG_M or turned_rad > WRONG_RAD


def drive(played, pipeline, camera, way):
    """Of each step along a way, whether the robot is elsewhere than it believes."""
    eyes, before, found = Eyes(played), None, []
    tracker = Tracker(DEFAULT, Maps(played.graph), eyes, certain=False)
    for number, pose in enumerate(way):
        seen = pipeline.features_of(camera(pose, LEVEL))
        eyes.view = seen.model_copy(update={"seq": number, "stamp_ns": number})
        motion = NO_MOTION if before is None else moved(before, pose)
        before = pose
        tracker.observe(Observation(eyes.view, RANGES, moved=motion))
        of_map = COMPARED if tracker.here is None else tracker.compared
        seen = eyes.match(dict.fromkeys([*tracker.nearby(), *tracker.elsewhere]), of_map)
        tracker.confirm(tracker.possible(seen, of_map=of_map > 0))
        found.append(is_wrong(played, tracker.here, pose))
    return found


@pytest.mark.parametrize("name", WORLDS)
def test_how_far_a_robot_drives_that_is_elsewhere_than_it_believes(name, keep):
    folder, pipeline = Path(os.environ["SUITE"]) / name, Pipeline(find_profile("sift"))
    played, rng = PlayedWorld(folder, name, pipeline), np.random.default_rng(5)
    world = load_world(str(folder / f"{name}{WHEN}.yaml"))
    camera, free = tilting_camera(world), free_space(world)
    ways = []
    for _ in range(int(os.environ.get("WAYS", WAYS))):
        way = poses_along(played, free, rng, STEP_M, rng.uniform(0.3, 0.7))
        ways.append(drive(played, pipeline, camera, way))
    steps = [step for way in ways for step in way]
    keep(
        {
            "ways": ["".join(SIGNS[step] for step in way) for way in ways],
            "steps": len(steps),
            "unknown": steps.count(None),
            "wrong": steps.count(True),
            "began_wrong": sum(bool(next((step for step in way if step is not None), False)) for way in ways),
        }
    )
