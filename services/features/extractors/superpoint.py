"""SuperPoint (DeTone et al. 2018), the thesis's choice; its weights are for non-commercial research only."""

import torch

from services.features.networks.keypoint_network import Found, KeypointNetwork
from services.features.networks.runtime import loading, require_consent
from services.features.pipeline.interfaces import Profile

REPOSITORY = "magic-leap-community/superpoint"


class SuperPoint(KeypointNetwork):
    """As `transformers` has it."""

    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        del profile
        from transformers import SuperPointConfig, SuperPointForKeypointDetection

        if not trained:
            return SuperPointForKeypointDetection(SuperPointConfig(max_keypoints=self._most))
        require_consent("superpoint")
        with loading("superpoint"):
            return SuperPointForKeypointDetection.from_pretrained(REPOSITORY, max_keypoints=self._most)

    def _find(self, batch: torch.Tensor) -> list[Found]:
        height, width = batch.shape[-2:]
        out = self._network(batch)
        size = torch.tensor([width, height], device=batch.device)
        found = []
        for keypoints, scores, descriptors, mask in zip(
            out.keypoints, out.scores, out.descriptors, out.mask.bool(), strict=True
        ):
            found.append(Found(keypoints[mask] * size, scores[mask], descriptors[mask]))
        return found
