"""DISK (Tyszkiewicz et al. 2020): keypoints and descriptors trained by reinforcement."""

import kornia.feature as kf
import torch

from services.features.networks.keypoint_network import Found, KeypointNetwork
from services.features.networks.runtime import loading
from services.features.pipeline.interfaces import Profile


class Disk(KeypointNetwork):
    """The 'depth' checkpoint."""

    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        del profile
        if not trained:
            return kf.DISK()
        with loading("disk"):
            return kf.DISK.from_pretrained("depth")

    def _find(self, batch: torch.Tensor) -> list[Found]:
        found = self._network(batch, n=self._most, pad_if_not_divisible=True)
        return [Found(f.keypoints, f.detection_scores, f.descriptors) for f in found]
