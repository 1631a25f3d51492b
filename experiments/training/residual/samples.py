"""Pairs of pictures as a descriptor learns from them: keypoints, partners, and what is no negative."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from experiments.training.correspondences import correspondences
from experiments.training.data.shards import Pair, trainable
from services.features.networks.attention import context_of
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import IndexArray
from services.features.pipeline.pipeline import Pipeline

NEAR_RAD = float(np.deg2rad(3.0))
"""Nearer to the true place a keypoint is no wrong answer, and none that must be right."""
FEWEST = 8
"""Partners below which a pair teaches little; chosen."""


@dataclass(frozen=True, eq=False)
class Sample:
    """One pair.

    Attributes:
        descriptors: of both pictures, (N, 128) and (M, 128).
        contexts: (N, 4) and (M, 4).
        partners: (K, 2) keypoints that are the same point.
        near: (N, M) whether the second is near where the first truly is.
    """

    descriptors: tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]
    contexts: tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]
    partners: IndexArray
    near: npt.NDArray[np.bool_]


def samples_of(paths: Sequence[Path], pipeline: Pipeline) -> list[Sample]:
    """Samples of all shards, those with enough partners.

    Raises:
        ExperimentError: a shard is corrupted, or of a world by which training is judged.
    """
    found = (sample_of(pair, pipeline) for path in paths for pair in trainable(path).pairs)
    return [sample for sample in found if len(sample.partners) >= FEWEST]


def sample_of(pair: Pair, pipeline: Pipeline) -> Sample:
    """What one pair of pictures teaches."""
    here, there = pair.here, pair.there
    first, second = (
        extract(sight.picture, pipeline.extractor, pipeline.representation, pipeline.profile)
        for sight in (here, there)
    )
    truth = correspondences(first.lonlat_rad, second.lonlat_rad, here, there)
    return Sample(
        (first.descriptors.astype(np.float32), second.descriptors.astype(np.float32)),
        (context_of(first), context_of(second)),
        truth.pairs,
        truth.off_rad < NEAR_RAD,
    )
