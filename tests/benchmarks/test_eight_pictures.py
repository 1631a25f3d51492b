"""How long it takes to match a picture with eight others by attention; gates nothing.

pytest -q -s tests/benchmarks/test_eight_pictures.py

Renderings of the apartment, beside each other as a robot's are. On one core, on all that torch has, which
share each product out, and as the service does it: each core takes some of the pictures.
"""

import time

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from experiments.rendered.frames import tilting_camera  # noqa: E402
from services.features.matching.verification import feature_set  # noqa: E402
from services.features.pipeline.named_pipelines import combined  # noqa: E402
from services.features.pipeline.pipeline import Pipeline  # noqa: E402
from shared.messages.simulation import Pose  # noqa: E402
from simulator.sensors.attitude import LEVEL  # noqa: E402
from simulator.world.freespace import free_space  # noqa: E402
from simulator.world.world_file import load_world  # noqa: E402

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(1200)]

PICTURES, OTHERS, SEED = 40, 8, 1


def pictures(pipeline):
    """Features of as many views, from spots drawn by chance."""
    world = load_world("apartment")
    camera, free, rng = tilting_camera(world), free_space(world), np.random.default_rng(SEED)
    poses = [
        Pose(x_m=x, y_m=y, yaw_rad=yaw) for x, y, yaw in (free.random_pose(rng) for _ in range(PICTURES))
    ]
    return [feature_set(pipeline.features_of(camera(pose, LEVEL))) for pose in poses]


def ms_a_pair(matcher, seen):
    """Of each picture with those after it, the median."""
    taken_s = []
    for number in range(PICTURES - OTHERS):
        begun_s = time.perf_counter()
        matcher.match(seen[number], seen[number + 1 : number + 1 + OTHERS])
        taken_s.append(time.perf_counter() - begun_s)
    return 1e3 * float(np.median(taken_s)) / OTHERS


def test_matching_eight_pictures_at_once(keep):
    pipeline = Pipeline(combined("sift", "equirectangular", "topnav-attention"))
    seen, matcher = pictures(pipeline), pipeline.matcher
    cores, figures = torch.get_num_threads(), {"keypoints": len(seen[0]), "cores": torch.get_num_threads()}
    for name, threads, shares in (("shared", cores, cores), ("products_shared", cores, 1), ("one", 1, 1)):
        torch.set_num_threads(threads)
        matcher._side_by_side.count = shares
        ms_a_pair(matcher, seen)
        figures[name] = ms_a_pair(matcher, seen)
    torch.set_num_threads(cores)
    keep({**figures, "shared_over_one": figures["shared"] / figures["one"]})
