"""The picture as it is, edges and all: what a pipeline for flat pictures would see."""

import math

import numpy as np

from services.features.pipeline.interfaces import BoolArray, FloatArray, Image, Profile, View
from services.features.representations.strip import cropped_strip


class Planar:
    """Cropped and resized picture without any care for the seam."""

    def __init__(self, profile: Profile) -> None:
        self._profile = profile

    def views(self, gray: Image) -> list[View]:
        """One view."""
        strip, grid = cropped_strip(gray, self._profile.crop_deg, self._profile.resize)
        return [View(strip, math.pi / grid.full_height, grid.lonlat_from_pixels, _all)]


def _all(pixels: FloatArray) -> BoolArray:
    return np.ones(len(pixels), dtype=np.bool_)
