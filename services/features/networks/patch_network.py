"""Networks that describe patches: TFeat, HardNet, HardNet8, SOSNet, MKD, behind one of kornia's detectors."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

import kornia.feature as kf
import numpy as np
import numpy.typing as npt
import torch

from services.features.networks.runtime import batch_of, device_named, loading, unit_descriptors
from services.features.pipeline.interfaces import Detections, Distance, Image, IndexArray, Profile, Runtime

CANDIDATES = 3
"""Keypoints asked of the detector per keypoint kept, as in keypoint_network."""
PATCH_PX = 32
"""Side of the patches that all of these were trained on."""
HARRIS_K = 0.04
"""Harris's constant, as in kornia's example and OpenCV's manual."""


class PatchNetwork(ABC):
    """Detector, then shape (AffNet) and orientation (OriNet) if asked for, then descriptors of patches."""

    distance: Distance = "euclidean"

    def __init__(self, profile: Profile, runtime: Runtime) -> None:
        self._device, trained = device_named(runtime.device), runtime.trained
        self._detector = _detector(profile, trained=trained).to(self._device).eval()
        self._steps: list[torch.nn.Module] = []
        if profile.affnet:
            with loading("affnet", trained=trained):
                self._steps.append(kf.LAFAffNetShapeEstimator(pretrained=trained))
        if not profile.upright:
            with loading("orinet", trained=trained):
                self._steps.append(kf.LAFOrienter(PATCH_PX, angle_detector=kf.OriNet(pretrained=trained)))
        for step in self._steps:
            step.to(self._device).eval()
        self._describe = describing(self._build(trained=trained), self._device)

    @abstractmethod
    def _build(self, *, trained: bool) -> torch.nn.Module:
        """The descriptor of 32 x 32 patches."""

    def detect(self, grays: Sequence[Image]) -> list[Detections]:
        """Keypoints of all views; the handle holds their frames (N, 2, 3)."""
        detections = []
        with torch.inference_mode():
            for gray in grays:
                frames, scores = self._detector(batch_of([gray], 1, self._device))
                pixels = frames[0, :, :, 2].double().cpu().numpy() + 0.5
                detections.append(Detections(pixels, scores[0].float().cpu().numpy(), frames))
        return detections

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[Any]]:
        """Unit descriptors (M, 128) of the chosen frames."""
        if len(chosen) == 0:
            return chosen, np.zeros((0, 128), np.float16)
        with torch.inference_mode():
            picture = batch_of([gray], 1, self._device)
            frames = detections.handle[:, torch.as_tensor(chosen, device=self._device)]
            for step in self._steps:
                frames = step(frames, picture)
            return chosen, unit_descriptors(self._describe(picture, frames)[0])


def describing(network: torch.nn.Module, device: torch.device) -> torch.nn.Module:
    """Cuts patches out of a picture and has a network describe them."""
    return kf.LAFDescriptor(network.eval(), PATCH_PX, grayscale_descriptor=True).to(device).eval()


def _detector(profile: Profile, *, trained: bool) -> torch.nn.Module:
    count = CANDIDATES * profile.keypoints
    if profile.detector == "keynet":
        with loading("keynet", trained=trained):
            return kf.KeyNetDetector(pretrained=trained, num_features=count)
    response = kf.CornerGFTT() if profile.detector == "gftt" else kf.CornerHarris(HARRIS_K)
    return kf.MultiResolutionDetector(response, num_features=count)
