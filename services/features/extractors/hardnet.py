"""HardNet (Mishchuk et al. 2017): trained with the hardest negative of each batch."""

import kornia.feature as kf
import torch

from services.features.networks.patch_network import PatchNetwork
from services.features.networks.runtime import loading


class HardNet(PatchNetwork):
    """128 numbers per patch."""

    def _build(self, *, trained: bool) -> torch.nn.Module:
        with loading("hardnet", trained=trained):
            return kf.HardNet(pretrained=trained)
