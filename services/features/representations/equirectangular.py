"""The whole panorama as one picture, continued across its seam.

Columns of the other side are pasted beyond both edges, so that a keypoint at the seam is found and described
as anywhere else; only those inside the original columns are reported, hence each once.
"""

import math

import cv2
import numpy as np

from services.features.pipeline.interfaces import BoolArray, FloatArray, Image, Profile, View
from services.features.representations.strip import cropped_strip

PAD_COLUMNS = 64
"""Wide enough for the window of nearly all keypoints; a multiple of 2^6 keeps the pyramid's phase."""


class Equirectangular:
    """Cropped and resized panorama with a continued seam."""

    def __init__(self, profile: Profile) -> None:
        self._profile = profile

    def views(self, gray: Image) -> list[View]:
        """One view."""
        strip, grid = cropped_strip(gray, self._profile.crop_deg, self._profile.resize)
        pad = min(PAD_COLUMNS, grid.width)
        padded = cv2.copyMakeBorder(strip, 0, 0, pad, pad, cv2.BORDER_WRAP)

        def lonlat_from_pixels(pixels: FloatArray) -> FloatArray:
            return grid.lonlat_from_pixels(pixels - np.array([pad, 0.0]))

        def owns(pixels: FloatArray) -> BoolArray:
            return np.asarray((pixels[:, 0] >= pad) & (pixels[:, 0] < pad + grid.width))

        return [
            View(np.asarray(padded, dtype=np.uint8), math.pi / grid.full_height, lonlat_from_pixels, owns)
        ]
