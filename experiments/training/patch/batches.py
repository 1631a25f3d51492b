"""Batches of pairs of patches: from several panoramas and worlds, no two of one spot."""

import numpy as np

from experiments.training.patch.samples import Patches
from services.features.pipeline.interfaces import BoolArray, IndexArray

NEAR_RAD = float(np.deg2rad(3.0))
"""Patches whose centres are nearer show mostly the same: neither is a wrong answer for the other."""
SPARE = 1.25
"""Pairs drawn for each of a batch: those near another one are left out."""


def draw_batch(patches: Patches, count: int, panoramas: int, rng: np.random.Generator) -> IndexArray:
    """Rows of a batch.

    Args:
        patches: all there are.
        count: rows wanted; there are fewer where spots are few.
        panoramas: pairs of panoramas that they are from: patches of the same picture tell apart what a robot
            must, those of many pictures are of many kinds.
        rng: draws them.
    """
    begins = patches.begins
    lengths = np.diff(begins, append=len(patches))
    chosen = rng.choice(len(begins), min(panoramas, len(begins)), replace=False)
    of = chosen[np.arange(round(SPARE * count)) % len(chosen)]
    rows = begins[of] + (rng.random(len(of)) * lengths[of]).astype(np.intp)
    return np.asarray(rows[_alone(patches[rows])][:count], np.intp)


def near(patches: Patches) -> BoolArray:
    """(N, N) whether two show the same spot: nearly the same point, or overlapping parts of one picture."""
    points = patches.points_m.astype(np.float64)
    squares = (points**2).sum(axis=-1)
    apart_m2 = squares[:, None] + squares - 2.0 * points @ points.T
    reach_m = NEAR_RAD * np.maximum(patches.ranges_m[:, None], patches.ranges_m)
    here, there = patches.bearings[:, 0], patches.bearings[:, 1]
    cosines = np.maximum(here @ here.T, there @ there.T)
    overlapping = (patches.panoramas[:, None] == patches.panoramas) & (cosines > np.cos(NEAR_RAD))
    same_world = patches.worlds[:, None] == patches.worlds
    return np.asarray(same_world & ((apart_m2 < reach_m**2) | overlapping))


def _alone(patches: Patches) -> BoolArray:
    """(N,) which are near none before them; each world by itself, as others share no spot."""
    alone = np.ones(len(patches), np.bool_)
    for world in np.unique(patches.worlds):
        rows = np.flatnonzero(patches.worlds == world)
        alone[rows] = ~np.triu(near(patches[rows]), 1).any(axis=0)
    return alone
