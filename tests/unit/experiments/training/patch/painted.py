"""A box whose walls are painted: the same paint from wherever it is seen."""

import cv2
import numpy as np

from experiments.training.data.shards import Pair, Shard, write_shard
from experiments.training.patch.batches import NEAR_RAD
from experiments.training.patch.samples import Patches
from experiments.training.sights import CameraPose, Sight
from simulator.sensors.panorama import directions
from tests.unit.experiments.training.boxes import WIDTH, in_a_box

CELLS_M = 0.05
PAINT = cv2.GaussianBlur(np.random.default_rng(3).integers(0, 256, (160, 160, 80), np.uint8), (5, 5), 1.0)


def painted(pose: CameraPose, hidden: bool = False) -> Sight:
    """What a camera sees in the painted box; if hidden, of everything something else stands before."""
    blank = in_a_box(pose, hidden)
    points = pose.position_m + (directions(WIDTH) @ pose.rotation.T) * blank.ranges_m[..., None]
    x, y, z = (np.floor(points / CELLS_M).astype(int)[..., k] for k in range(3))
    grey = cv2.normalize(PAINT[x % 160, y % 160, z % 80], None, 0, 255, cv2.NORM_MINMAX)
    return Sight(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), blank.ranges_m, pose)


def painted_pair(hidden: bool = False) -> Pair:
    """Two places of the box, 0.9 m apart."""
    here, there = CameraPose(0.0, 0.0, 0.3, 0.8), CameraPose(0.9, -0.2, -0.5, 0.85, (0.03, -0.02))
    return Pair(painted(here), painted(there, hidden), (0.9, 0.9))


def write_painted(folder, world, pairs):
    """A shard of such pairs."""
    jpegs = [
        bytes(cv2.imencode(".jpg", sight.picture)[1]) for pair in pairs for sight in (pair.here, pair.there)
    ]
    return write_shard(folder, f"{world}-000", Shard(world, pairs, {"recipe": {"seed": 7}}), jpegs)


def noise(count: int, panoramas: int, worlds: int = 1, seed: int = 0) -> Patches:
    """Pairs of patches of noise, the second much like the first, all of spots far from one another."""
    rng = np.random.default_rng(seed)
    first = rng.integers(0, 256, (count, 32, 32))
    second = np.clip(first + rng.integers(-60, 61, first.shape), 0, 255)
    of = np.sort(np.arange(count) % panoramas).astype(np.int32)
    turns = np.arange(count) * 2.0 * NEAR_RAD
    bearings = np.stack([np.cos(turns), np.sin(turns), np.zeros(count)], axis=-1)
    return Patches(
        np.stack([first, second], axis=1).astype(np.uint8),
        of,
        of % worlds,
        np.arange(3 * count, dtype=np.float32).reshape(count, 3),
        np.full(count, 2.0, np.float32),
        np.stack([bearings, bearings], axis=1).astype(np.float32),
    )
