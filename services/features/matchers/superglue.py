"""SuperGlue (Sarlin et al. 2020), the thesis's matcher of SuperPoint; non-commercial weights."""

from collections.abc import Sequence

import numpy as np
import torch

from services.features.networks.runtime import (
    HEIGHT_PX,
    WIDTH_PX,
    device_named,
    loading,
    pixels_of,
    require_consent,
)
from services.features.pipeline.interfaces import Distance, FeatureSet, IndexArray, Matched, Profile, Runtime

REPOSITORY = "magic-leap-community/superglue_{}"


class SuperGlue:
    """Indoor weights, or outdoor ones by the plugin's name (Q23)."""

    def __init__(self, profile: Profile, distance: Distance, runtime: Runtime) -> None:
        del distance
        from transformers import SuperGlueConfig, SuperGlueForKeypointMatching

        self._device = device_named(runtime.device)
        if runtime.trained:
            require_consent("superglue")
            weights = "outdoor" if profile.matcher.endswith("outdoor") else "indoor"
            with loading(f"superglue-{weights}"):
                network = SuperGlueForKeypointMatching.from_pretrained(REPOSITORY.format(weights))
        else:
            network = SuperGlueForKeypointMatching(SuperGlueConfig())
        self._network = network.to(self._device).eval()

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame."""
        return [Matched.alike(self._pair(query, other)) for other in others]

    def _pair(self, query: FeatureSet, other: FeatureSet) -> IndexArray:
        count = max(len(query), len(other))
        if min(len(query), len(other)) == 0:
            return np.zeros((0, 2), dtype=np.intp)
        keypoints = torch.zeros(1, 2, count, 2, device=self._device)
        descriptors = torch.zeros(1, 2, count, query.descriptors.shape[1], device=self._device)
        scores = torch.zeros(1, 2, count, device=self._device)
        mask = torch.zeros(1, 2, count, dtype=torch.int, device=self._device)
        for side, features in enumerate((query, other)):
            size = len(features)
            keypoints[0, side, :size] = pixels_of(features.lonlat_rad, self._device)[0]
            descriptors[0, side, :size] = torch.as_tensor(features.descriptors.astype(np.float32))
            scores[0, side, :size] = torch.as_tensor(features.scores)
            mask[0, side, :size] = 1
        with torch.inference_mode():
            # The public call detects anew with SuperPoint; this is the matching alone.
            matches = self._network._match_image_pair(
                keypoints, descriptors, scores, HEIGHT_PX, WIDTH_PX, mask=mask
            )[0][0, 0, : len(query)]
        target = matches.cpu().numpy().astype(np.intp)
        rows = np.flatnonzero((target >= 0) & (target < len(other)))
        return np.stack([rows, target[rows]], axis=1)
