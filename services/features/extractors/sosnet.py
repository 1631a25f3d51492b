"""SOSNet (Tian et al. 2019): trained with second-order similarity."""

import kornia.feature as kf
import torch

from services.features.networks.patch_network import PatchNetwork
from services.features.networks.runtime import loading


class SosNet(PatchNetwork):
    """128 numbers per patch."""

    def _build(self, *, trained: bool) -> torch.nn.Module:
        with loading("sosnet", trained=trained):
            return kf.SOSNet(pretrained=trained)
