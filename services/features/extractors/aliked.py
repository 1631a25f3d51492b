"""ALIKED (Zhao et al. 2023): keypoints with deformable descriptors; variants t16, n16, n16rot, n32."""

import kornia.feature as kf
import torch

from services.features.networks.keypoint_network import CANDIDATES, Found, KeypointNetwork
from services.features.networks.runtime import loading
from services.features.pipeline.interfaces import Profile

THRESHOLD = 0.01
"""Far below the 0.2 of its authors: plain walls answer weakly, and only the strongest are kept anyway."""


class Aliked(KeypointNetwork):
    """The variant is the extractor's name."""

    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        limits = {"max_num_keypoints": CANDIDATES * profile.keypoints, "detection_threshold": THRESHOLD}
        if not trained:
            return kf.ALIKED(profile.extractor, **limits)
        with loading(profile.extractor):
            return kf.ALIKED.from_pretrained(profile.extractor, **limits)

    def _find(self, batch: torch.Tensor) -> list[Found]:
        return [Found(f.keypoints, f.keypoint_scores, f.descriptors) for f in self._network(batch)]
