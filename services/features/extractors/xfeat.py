"""XFeat (Potje et al. 2024): a small network made for processors without a GPU."""

import kornia.feature as kf
import torch

from services.features.networks.keypoint_network import Found, KeypointNetwork
from services.features.networks.runtime import loading
from services.features.pipeline.interfaces import Profile

THRESHOLD = 0.01
"""A fifth of its authors' 0.05, for the same reason as in aliked."""


class XFeat(KeypointNetwork):
    """Sparse keypoints of XFeat."""

    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        del profile
        if not trained:
            return kf.XFeat(self._most, THRESHOLD)
        with loading("xfeat"):
            return kf.XFeat.from_pretrained(self._most, THRESHOLD)

    def _find(self, batch: torch.Tensor) -> list[Found]:
        found = self._network.detectAndCompute(batch)
        return [Found(f["keypoints"], f["scores"], f["descriptors"]) for f in found]
