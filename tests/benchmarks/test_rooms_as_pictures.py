"""By how much rooms furnished alike differ as pictures, right beside the same spot of each; gates nothing.

pytest -q -s tests/benchmarks/test_rooms_as_pictures.py
WORLDS=hostel-6-small SPOTS=10 pytest -q -s tests/benchmarks/test_rooms_as_pictures.py

A robot stands up to 5 cm from where a goal picture was taken, in the right room or in another one of the
building (decision 0033). Spots are drawn on the floor of the room, between and above its furniture.
"""

import math
import os

import numpy as np
import pytest

from experiments.rendered.frames import tilting_camera
from services.features.matching.difference import differences
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.planner.goals.picture_levels import largest
from services.planner.look_alikes import FITS_LEVELS
from shared.messages.simulation import Pose
from simulator.generation.alike import door_is_south
from simulator.generation.kinds import KINDS, SIZES
from simulator.sensors.attitude import LEVEL
from tests.benchmarks.test_exploring_plans import world_of

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

WORLDS = "hostel-0-small,hostel-1-small,hostel-3-small,hotel-1-small,hotel-4-small,hotel-6-small"
SPOTS, WITHIN_SHARE, ASIDE_M = 6, 0.35, (0.01, 0.05)


def plan_of(name):
    """The plan that the generator draws first."""
    kind, seed, size = name.rsplit("-", 2)
    rng = np.random.default_rng([int(seed), SIZES.index(size), *kind.encode()])
    return KINDS[kind].plan(SIZES.index(size), rng)


def alike_rooms(plan):
    """Those furnished alike, the largest number of one size."""
    by_size = {}
    for room in plan.rooms:
        if room.use in plan.alike:
            by_size.setdefault(tuple(np.round(room.rect.size_m, 2)), []).append(room)
    return max(by_size.values(), key=len)


@pytest.mark.parametrize("name", os.environ.get("WORLDS", WORLDS).split(","))
def test_by_how_much_rooms_differ_beside_the_same_spot(name, tmp_path, keep):
    camera, pipeline, plan = (
        tilting_camera(world_of(name, tmp_path)),
        Pipeline(find_profile("sift")),
        plan_of(name),
    )
    rooms, rng = alike_rooms(plan), np.random.default_rng(5)

    def view(room, at_m):
        turn = -1.0 if door_is_south(room, plan) else 1.0
        x_m, y_m = np.array(room.rect.centre_m) + turn * at_m
        pose = Pose(x_m=x_m, y_m=y_m, yaw_rad=0.0 if turn > 0.0 else math.pi)
        return pipeline.features_of(camera(pose, LEVEL)).thumbnail

    right, others = [], []
    for _ in range(int(os.environ.get("SPOTS", SPOTS))):
        spot_m = rng.uniform(-WITHIN_SHARE, WITHIN_SHARE, 2) * rooms[0].rect.size_m
        for of_goal in rooms:
            goal = view(of_goal, spot_m)
            for room in rooms:
                angle = rng.uniform(0.0, math.tau)
                aside_m = rng.uniform(*ASIDE_M) * np.array([math.cos(angle), math.sin(angle)])
                levels = largest(differences(view(room, spot_m + aside_m), goal, 0.0))
                (right if room is of_goal else others).append(levels)
    fit = float(np.mean(np.array(right) <= FITS_LEVELS))
    told = {"right": len(right), "median": np.median(right), "fit": fit}
    keep(told | {"others": len(others), "others_least": min(others), "others_median": np.median(others)})
