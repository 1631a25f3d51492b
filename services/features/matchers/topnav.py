"""Matching by attention over bearings, trained here (deploy/TRAINING.md)."""

from collections.abc import Sequence

import numpy as np
import torch

from services.features.matchers.mutual_ratio import MutualRatio
from services.features.networks.attention import CONTEXT, Attention, Keypoints, context_of
from services.features.networks.own_weights import own_weights
from services.features.networks.runtime import device_named
from services.features.pipeline.interfaces import (
    Distance,
    FeatureSet,
    IndexArray,
    Matched,
    Profile,
    Runtime,
)
from services.features.pipeline.named_pipelines import ATTENTION

LEAST_RIGHT = 0.1
"""Matches less likely right than this are left out (LightGlue's threshold)."""
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

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame; beyond LOOKED_AT frames those of nearest neighbours."""
        quick = self._quick.match(query, others)
        ranked = sorted(range(len(others)), key=lambda k: (-len(quick[k]), k))[:LOOKED_AT]
        one = self._keypoints(query) if ranked and len(query) else None
        for number in ranked:
            if one is not None and len(others[number]):
                quick[number] = self._matched(one, self._keypoints(others[number]))
        return quick

    def _matched(self, one: Keypoints, other: Keypoints) -> Matched:
        with torch.inference_mode():
            answer = self._network.last(one, other, HOPELESS)
        if answer is None:
            return Matched.alike(np.zeros((0, 2), dtype=np.intp))
        right = answer.log_right[0].exp().cpu().numpy()
        nearest = right.argmax(axis=1)
        rows = np.arange(len(right))
        mutual = right.argmax(axis=0)[nearest] == rows
        likely = right[rows, nearest].astype(np.float64)
        kept: IndexArray = np.flatnonzero(mutual & (likely >= LEAST_RIGHT))
        return Matched(np.stack([kept, nearest[kept]], axis=1), likely[kept])

    def _keypoints(self, features: FeatureSet) -> Keypoints:
        vectors = torch.from_numpy(features.descriptors.astype(np.float32))
        parts = (
            torch.from_numpy(np.ascontiguousarray(features.lonlat_rad, np.float32)),
            torch.nn.functional.normalize(vectors, dim=-1),
            torch.from_numpy(context_of(features)),
        )
        return Keypoints(*(part[None].to(self._device) for part in parts))
