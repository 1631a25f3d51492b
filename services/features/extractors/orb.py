"""ORB (Rublee et al. 2011): oriented FAST corners, 256 comparisons as 32 bytes (thesis, appendix A)."""

from collections.abc import Sequence
from typing import Any

import cv2
import numpy.typing as npt

from services.features.extractors.opencv_keypoints import describe_chosen, detections_from_keypoints
from services.features.pipeline.interfaces import Detections, Distance, Image, IndexArray, Profile

CANDIDATES = 8
"""Corners looked for per keypoint kept, so that no level of the pyramid runs into its quota."""

FAST_THRESHOLD = 5
"""Grey levels; OpenCV's 20 leaves plain walls empty."""

WIDTH = 32
"""Bytes: 256 comparisons."""


def create_orb(profile: Profile) -> Any:
    """OpenCV's ORB with thresholds for indoor walls; also the detector of BEBLID."""
    return cv2.ORB.create(nfeatures=CANDIDATES * profile.keypoints, fastThreshold=FAST_THRESHOLD)


class Orb:
    """ORB detector and descriptor."""

    distance: Distance = "hamming"

    def __init__(self, profile: Profile) -> None:
        self._orb = create_orb(profile)
        self._upright = profile.upright

    def detect(self, grays: Sequence[Image]) -> list[Detections]:
        """Find oriented FAST corners."""
        return [detections_from_keypoints(self._orb.detect(gray, None)) for gray in grays]

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[Any]]:
        """Describe the chosen ones, 32 bytes each."""
        return describe_chosen(self._orb, gray, detections, chosen, WIDTH, self._upright)
