"""HardNet8 (Pultar 2020): HardNet with eight layers."""

import kornia.feature as kf
import torch

from services.features.networks.patch_network import PatchNetwork
from services.features.networks.runtime import loading


class HardNet8(PatchNetwork):
    """128 numbers per patch."""

    def _build(self, *, trained: bool) -> torch.nn.Module:
        with loading("hardnet8", trained=trained):
            return kf.HardNet8(pretrained=trained)
