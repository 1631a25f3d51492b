"""MKD (Mukundan et al. 2019): kernels of gradients, by hand but for the whitening, which was learnt."""

import kornia.feature as kf
import torch

from services.features.networks.patch_network import PATCH_PX, PatchNetwork
from services.features.networks.runtime import loading

WIDTH = 128


class Mkd(PatchNetwork):
    """128 numbers per patch; without its weights neighbours are averaged instead of whitened."""

    def _build(self, *, trained: bool) -> torch.nn.Module:
        if not trained:
            raw = kf.MKDDescriptor(PATCH_PX, whitening=None)
            return torch.nn.Sequential(raw, torch.nn.AdaptiveAvgPool1d(WIDTH))
        with loading("mkd"):
            return kf.MKDDescriptor(PATCH_PX, output_dims=WIDTH)
