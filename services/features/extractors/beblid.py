"""BEBLID (Suarez et al. 2020): boosted binary descriptor, 64 bytes (thesis, appendix A), on ORB's corners."""

from collections.abc import Sequence
from typing import Any

import cv2
import numpy.typing as npt

from services.features.extractors.opencv_keypoints import describe_chosen, detections_from_keypoints
from services.features.extractors.orb import create_orb
from services.features.pipeline.interfaces import Detections, Distance, Image, IndexArray, Profile

ORB_SCALE = 1.0
"""Sampling window for ORB key points, from OpenCV's documentation of BEBLID."""

WIDTH = 64
"""Bytes: 512 bits."""


class Beblid:
    """ORB detector, BEBLID descriptor."""

    distance: Distance = "hamming"

    def __init__(self, profile: Profile) -> None:
        self._orb = create_orb(profile)
        self._beblid = cv2.xfeatures2d.BEBLID.create(ORB_SCALE, cv2.xfeatures2d.BEBLID_SIZE_512_BITS)
        self._upright = profile.upright

    def detect(self, grays: Sequence[Image]) -> list[Detections]:
        """Find oriented FAST corners."""
        return [detections_from_keypoints(self._orb.detect(gray, None)) for gray in grays]

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[Any]]:
        """Describe the chosen ones, 64 bytes each."""
        return describe_chosen(self._beblid, gray, detections, chosen, WIDTH, self._upright)
