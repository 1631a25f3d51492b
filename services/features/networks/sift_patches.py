"""SIFT's keypoints, described by a network that sees the patch round each instead of by histograms."""

from abc import ABC, abstractmethod
from typing import Any

import kornia.feature as kf
import numpy as np
import numpy.typing as npt
import torch

from services.features.extractors.sift import Sift
from services.features.networks.patch_network import describing
from services.features.networks.patch_shapes import WIDTH
from services.features.networks.runtime import batch_of, device_named, unit_descriptors
from services.features.pipeline.interfaces import Detections, Image, IndexArray, Profile, Runtime

HALF_SIDE = 3.0
"""Half of the patch's side by OpenCV's size of a keypoint: SIFT's own 4 x 4 cells are as wide (Lowe 2004)."""


class SiftPatches(Sift, ABC):
    """Extrema of the difference of Gaussians with their size and orientation; unit descriptors (M, 128)."""

    def __init__(self, profile: Profile, runtime: Runtime) -> None:
        super().__init__(profile)
        self._device = device_named(runtime.device)
        self._describe = describing(self._build(trained=runtime.trained), self._device)

    @abstractmethod
    def _build(self, *, trained: bool) -> torch.nn.Module:
        """The descriptor of 32 x 32 patches."""

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[Any]]:
        """Describe the chosen ones."""
        if len(chosen) == 0:
            return chosen, np.zeros((0, WIDTH), np.float16)
        with torch.inference_mode():
            frames = self._frames([detections.handle[index] for index in chosen]).to(self._device)
            return chosen, unit_descriptors(self._describe(batch_of([gray], 1, self._device), frames)[0])

    def _frames(self, keypoints: list[Any]) -> torch.Tensor:
        """Local affine frames (1, N, 2, 3); OpenCV's angles turn the other way."""
        spots = torch.tensor([[keypoint.pt for keypoint in keypoints]])
        sizes = torch.tensor([[keypoint.size for keypoint in keypoints]]) * HALF_SIDE * self._surroundings
        angles = torch.tensor([[0.0 if self._upright else -keypoint.angle for keypoint in keypoints]])
        return kf.laf_from_center_scale_ori(spots, sizes[..., None, None], angles[..., None])
