"""DeDoDe (Edstedt et al. 2024): a detector and a descriptor trained apart; detector L, descriptor B."""

import kornia.feature as kf
import torch

from services.features.networks.keypoint_network import Found, KeypointNetwork
from services.features.networks.runtime import loading
from services.features.pipeline.interfaces import Profile


class DeDoDe(KeypointNetwork):
    """Works on colours; grey pictures are given three times."""

    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        del profile
        if not trained:
            return kf.DeDoDe("L", "B", amp_dtype=torch.float32)
        with loading("dedode-detector"):
            return kf.DeDoDe.from_pretrained("L-C4-v2", "B-upright", amp_dtype=torch.float32)

    def _find(self, batch: torch.Tensor) -> list[Found]:
        keypoints, scores, descriptors = self._network(batch, n=self._most)
        return [Found(k, s, d) for k, s, d in zip(keypoints, scores, descriptors, strict=True)]
