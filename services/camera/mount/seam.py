"""The band along the seam of two fisheyes, blurred so that no keypoint is found in it. Pure.

Near things look different from the two lenses, which lie some centimetres apart: at the seam they break, and
the break moves with the camera. A filled band would have two edges of its own; a blurred one has none.
"""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import FloatArray

FEATHER = 0.5
"""Of the half width, over which the blur comes in on either side; chosen."""
BLUR = 1.0
"""Standard deviation of the blur over the half width; chosen: what is left is larger than keypoints are."""
REDUCTION = 8
"""The blurred picture is computed at an eighth of the size: 1 ms instead of 40 at 1920 columns."""


@dataclass(frozen=True, eq=False)
class SeamMask:
    """Places (N,) of the band's pixels in a flat panorama, weights (N, 1) of the blur there, its pixels."""

    places: npt.NDArray[np.intp]
    weights: npt.NDArray[np.float32]
    sigma_px: float

    @classmethod
    def along(cls, distance_rad: FloatArray, half_width_rad: float) -> "SeamMask":
        """The mask where `distance_rad` (H, W) from the seam is less than the half width, and feathered."""
        feather = FEATHER * half_width_rad
        weights = np.clip((half_width_rad + feather - distance_rad.ravel()) / feather, 0.0, 1.0)
        places = np.flatnonzero(weights)
        pixels_per_rad = distance_rad.shape[1] / (2.0 * np.pi)
        return cls(places, weights[places, None].astype(np.float32), BLUR * half_width_rad * pixels_per_rad)

    def blur(self, panorama: npt.NDArray[np.uint8]) -> None:
        """Blur the band of one panorama, (H, W, 3) in one piece of memory, in place."""
        height, width = panorama.shape[:2]
        size = max(1, width // REDUCTION), max(1, height // REDUCTION)
        small = cv2.resize(panorama, size, interpolation=cv2.INTER_AREA)
        small = cv2.GaussianBlur(small, (0, 0), max(0.5, self.sigma_px / REDUCTION))
        blurred = cv2.resize(small, (width, height)).reshape(-1, 3)[self.places]
        flat = panorama.reshape(-1, 3)
        sharp = flat[self.places].astype(np.float32)
        flat[self.places] = np.rint(sharp + self.weights * (blurred - sharp)).astype(np.uint8)
