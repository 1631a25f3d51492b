"""Extractors that were trained here, on rendered panoramas (deploy/TRAINING.md)."""

import torch

from services.features.networks.own_weights import folded, own_weights
from services.features.networks.patch_network import PatchNetwork
from services.features.networks.patch_shapes import network_named


class Slim(PatchNetwork):
    """HardNet (Mishchuk et al. 2017) with a quarter of its channels: 128 numbers per patch."""

    def _build(self, *, trained: bool) -> torch.nn.Module:
        network = network_named("slim")
        if trained:
            network.load_state_dict(own_weights("topnav-slim")[0])
        return folded(network.eval())
