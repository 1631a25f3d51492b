"""Extractors that were trained here, on rendered panoramas (deploy/TRAINING.md)."""

import torch

from services.features.networks.keypoint_network import Found, KeypointNetwork
from services.features.networks.own_weights import folded, own_weights
from services.features.networks.patch_network import PatchNetwork
from services.features.networks.patch_shapes import Shape as PatchShape
from services.features.networks.patch_shapes import network_named
from services.features.networks.sift_patches import SiftPatches
from services.features.networks.spherical_keypoints import described, network_of, strongest
from services.features.pipeline.interfaces import Profile


class _Trained:
    """128 numbers per patch, in the shape of HardNet (Mishchuk et al. 2017)."""

    weights: str
    shape: PatchShape

    def _build(self, *, trained: bool) -> torch.nn.Module:
        network = network_named(self.shape)
        if trained:
            network.load_state_dict(own_weights(self.weights)[0])
        return folded(network.eval())


class Slim(_Trained, PatchNetwork):
    """A quarter of HardNet's channels."""

    weights, shape = "topnav-slim", "slim"


class FullHardNet(_Trained, PatchNetwork):
    """All of HardNet's channels."""

    weights, shape = "topnav-hardnet", "hardnet"


class SiftSlim(_Trained, SiftPatches):
    """`Slim` on SIFT's keypoints."""

    weights, shape = "topnav-slim", "slim"


class SiftHardNet(_Trained, SiftPatches):
    """`FullHardNet` on SIFT's keypoints."""

    weights, shape = "topnav-hardnet", "hardnet"


class Keypoints(KeypointNetwork):
    """64 numbers, in one pass with the scores of all pixels (`spherical_keypoints`)."""

    channels = 1

    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        del profile
        network = network_of("slim")
        if trained:
            network.load_state_dict(own_weights("topnav-keypoints")[0])
        return folded(network.eval())

    def _find(self, batch: torch.Tensor) -> list[Found]:
        scores, maps = self._network(batch)
        pixels, values = strongest(scores, self._most)
        vectors = described(maps, self._network.strides, pixels)
        likely = values.sigmoid()
        return [
            Found(where[there] - 0.5, how[there], what[there])
            for where, how, what, there in zip(pixels, likely, vectors, torch.isfinite(values), strict=True)
        ]
