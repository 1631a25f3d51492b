"""Networks that find and describe keypoints at once: ALIKED, DISK, XFeat, DeDoDe, SuperPoint."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt
import torch

from services.features.networks.runtime import batch_of, device_named, unit_descriptors
from services.features.pipeline.interfaces import Detections, Distance, Image, IndexArray, Profile, Runtime

CANDIDATES = 3
"""Keypoints asked of the network per keypoint kept: some lie beyond the seam or too near others."""

BATCH = 8
"""Views per call: tangent pictures come eighty at a time."""


@dataclass(frozen=True, eq=False)
class Found:
    """What a network found in one picture: (N, 2) pixels from the centre of the first, (N,), (N, D)."""

    keypoints: torch.Tensor
    scores: torch.Tensor
    descriptors: torch.Tensor


class KeypointNetwork(ABC):
    """Detects in batches; to describe is only to choose rows."""

    distance: Distance = "euclidean"
    channels = 3

    def __init__(self, profile: Profile, runtime: Runtime) -> None:
        self._device = device_named(runtime.device)
        self._most = CANDIDATES * profile.keypoints
        self._network = self._build(profile, trained=runtime.trained).to(self._device).eval()

    @abstractmethod
    def _build(self, profile: Profile, *, trained: bool) -> torch.nn.Module:
        """The network; without training its parameters are whatever torch's generator draws."""

    @abstractmethod
    def _find(self, batch: torch.Tensor) -> list[Found]:
        """Keypoints of every picture of (B, channels, H, W)."""

    def detect(self, grays: Sequence[Image]) -> list[Detections]:
        """Keypoints and descriptors of all views; the handle holds the descriptors."""
        detections: list[Detections] = []
        with torch.inference_mode():
            for start in range(0, len(grays), BATCH):
                found = self._find(batch_of(grays[start : start + BATCH], self.channels, self._device))
                detections += [_detections(one) for one in found]
        return detections

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[Any]]:
        """Rows of the descriptors that came with the keypoints."""
        del gray
        return chosen, detections.handle[chosen]


def _detections(found: Found) -> Detections:
    pixels = found.keypoints.double().cpu().numpy().reshape(-1, 2) + 0.5
    return Detections(pixels, found.scores.float().cpu().numpy(), unit_descriptors(found.descriptors))
