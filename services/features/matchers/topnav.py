"""Matching by attention over bearings, trained here (deploy/TRAINING.md)."""

from collections.abc import Sequence

import numpy as np
import torch

from services.features.matchers.mutual_ratio import MutualRatio
from services.features.networks.attention import CONTEXT, Attention, Keypoints, context_of
from services.features.networks.own_weights import own_weights
from services.features.networks.runtime import device_named, quick_products
from services.features.networks.side_by_side import SideBySide
from services.features.pipeline.interfaces import (
    Distance,
    FeatureSet,
    Float32Array,
    IndexArray,
    Matched,
    Profile,
    Runtime,
)
from services.features.pipeline.named_pipelines import ATTENTION

LEAST_RIGHT = 0.1
"""Matches less likely right than this are left out (LightGlue's threshold)."""
COUNTED = 0.2
"""From here on they count as similarity (SuperGlue's threshold): with all of them two maps of the apartment
had one and two false edges, and none where the doubtful ones only help to find the motion."""
HOPELESS = 0.02
"""Probability of the same place below which the layers that are left are not asked."""
LOOKED_AT = 8
"""Frames of one question that are matched by attention, those with the most mutual neighbours: the others
show another place, and a robot that compares with a hundred nodes cannot wait for all."""
UNTRAINED_WIDTH = 128


class AttentionMatcher:
    """Mutual assignments that are likely right, each with its probability."""

    def __init__(self, profile: Profile, distance: Distance, runtime: Runtime) -> None:
        self._quick = MutualRatio(profile, distance)
        self._device = device_named(runtime.device)
        if runtime.trained:
            weights, recipe = own_weights(ATTENTION[profile.extractor])
            dimension = weights["enter.weight"].shape[1] - CONTEXT
            network = Attention(dimension, recipe["width"], recipe["heads"], recipe["layers"])
            network.load_state_dict(weights)
        else:
            network = Attention(UNTRAINED_WIDTH)
        self._network = network.to(self._device).eval()
        self._side_by_side = SideBySide(self._device)

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame; beyond LOOKED_AT frames those of nearest neighbours."""
        quick = self._quick.match(query, others)
        ranked = sorted(range(len(others)), key=lambda k: (-len(quick[k]), k))[:LOOKED_AT]
        looked_at = [number for number in ranked if len(others[number])]
        if len(query) and looked_at:
            chosen = [others[number] for number in looked_at]
            found = self._side_by_side.map(lambda part: self._matched(query, part), chosen)
            for number, matched in zip(looked_at, found, strict=True):
                quick[number] = matched
        return quick

    def _matched(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Of pictures looked at at once: a large product takes less time than small ones."""
        found = [Matched.alike(np.zeros((0, 2), dtype=np.intp))] * len(others)
        with torch.inference_mode(), quick_products(self._device):
            numbers, answer = self._network.last(self._keypoints([query]), self._keypoints(others), HOPELESS)
        if answer is not None:
            log_right = answer.log_right.cpu().numpy()
            for row, number in enumerate(numbers):
                found[number] = _mutual(log_right[row, :, : len(others[number])])
        return found

    def _keypoints(self, frames: Sequence[FeatureSet]) -> Keypoints:
        """A batch, filled up to the most keypoints of a frame."""
        most = max(map(len, frames))
        filled = [[np.pad(part, [(0, most - len(part)), (0, 0)]) for part in _parts(f)] for f in frames]
        lonlat, vectors, context = (
            torch.from_numpy(np.stack(column)).to(self._device) for column in zip(*filled, strict=True)
        )
        present = torch.arange(most) < torch.tensor([len(frame) for frame in frames])[:, None]
        return Keypoints(
            lonlat,
            torch.nn.functional.normalize(vectors, dim=-1),
            context,
            None if bool(present.all()) else present.to(self._device),
        )


def _parts(features: FeatureSet) -> tuple[Float32Array, Float32Array, Float32Array]:
    lonlat, vectors = features.lonlat_rad.astype(np.float32), features.descriptors.astype(np.float32)
    return lonlat, vectors, context_of(features)


def _mutual(log_right: Float32Array) -> Matched:
    """Those that are each other's most likely partner."""
    nearest = log_right.argmax(axis=1)
    rows = np.arange(len(log_right))
    mutual = log_right.argmax(axis=0)[nearest] == rows
    likely = np.exp(log_right[rows, nearest].astype(np.float64))
    kept: IndexArray = np.flatnonzero(mutual & (likely >= LEAST_RIGHT))
    return Matched(np.stack([kept, nearest[kept]], axis=1), likely[kept], likely[kept] < COUNTED)
