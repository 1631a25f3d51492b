"""TFeat (Balntas et al. 2016): a small network trained with triplets."""

import kornia.feature as kf
import torch

from services.features.networks.patch_network import PatchNetwork
from services.features.networks.runtime import loading


class TFeat(PatchNetwork):
    """128 numbers per patch."""

    def _build(self, *, trained: bool) -> torch.nn.Module:
        with loading("tfeat", trained=trained):
            return kf.TFeat(pretrained=trained)
