"""SIFT with the square-root (Hellinger) normalisation, kept as bytes.

Lowe 2004 for detector and descriptor; Arandjelovic and Zisserman 2012 for RootSIFT: d' = sqrt(d / |d|_1),
a unit vector whose Euclidean distance is the Hellinger distance of d. Bytes hold 512 d', clipped at 255.
"""

from collections.abc import Sequence

import cv2
import numpy as np
import numpy.typing as npt

from services.features.extractors.opencv_keypoints import describe_chosen, detections_from_keypoints
from services.features.pipeline.interfaces import Detections, Distance, Image, IndexArray, Profile

CONTRAST = 0.02
"""Below OpenCV's 0.04, because plaster carries faint texture only; 56 apartment frames had 826 or more."""

BYTE_SCALE = 512.0
"""OpenCV's SIFT_INT_DESCR_FCTR; a bin that holds more than a quarter of all is clipped."""
WIDTH = 128
"""4 x 4 cells of 8 orientations (Lowe 2004)."""
EDGE, SIGMA = 10.0, 1.6
"""Largest ratio of principal curvatures, and blur of the first octave (Lowe 2004, OpenCV's defaults)."""


class Sift:
    """Root SIFT."""

    distance: Distance = "euclidean"

    def __init__(self, profile: Profile) -> None:
        self._sift = cv2.SIFT.create(nfeatures=0, contrastThreshold=CONTRAST, edgeThreshold=EDGE, sigma=SIGMA)
        self._upright, self._surroundings = profile.upright, profile.surroundings

    def detect(self, grays: Sequence[Image]) -> list[Detections]:
        """Find extrema of the difference of Gaussians.

        The score is contrast times the root of the size: large blobs are found again from further away
        (measured at 1 to 1.5 m: 48 verified matches instead of 36 by contrast alone).
        """
        return [self._of_view(gray) for gray in grays]

    def _of_view(self, gray: Image) -> Detections:
        found = detections_from_keypoints(self._sift.detect(gray, None))
        sizes = np.asarray(found.sizes)
        once = first_of_each(np.column_stack([found.pixels, sizes]))
        scores = found.scores * np.sqrt(sizes)
        handle = tuple(found.handle[k] for k in once.tolist())
        return Detections(found.pixels[once], scores[once], handle, sizes[once])

    def describe(
        self, gray: Image, detections: Detections, chosen: IndexArray
    ) -> tuple[IndexArray, npt.NDArray[np.uint8]]:
        """Describe the chosen ones as bytes."""
        kept, raw = describe_chosen(
            self._sift, gray, detections, chosen, WIDTH, self._upright, self._surroundings
        )
        return kept, root_bytes(raw)


def first_of_each(rows: npt.NDArray[np.float64]) -> IndexArray:
    """Indices of the first of each group of equal rows (N, K), ascending.

    SIFT reports a point once per dominant orientation; to match, it is one point.
    """
    order = np.lexsort(rows.T)
    new = np.ones(len(rows), dtype=np.bool_)
    new[1:] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    return np.sort(order[new])


def root_bytes(raw: npt.NDArray[np.generic]) -> npt.NDArray[np.uint8]:
    """Square-root normalise (N, 128) SIFT histograms and scale them to bytes."""
    histograms = np.asarray(raw, dtype=np.float32)
    total = np.maximum(histograms.sum(axis=1, keepdims=True), 1e-6)
    scaled = np.rint(BYTE_SCALE * np.sqrt(histograms / total))
    return np.asarray(np.minimum(scaled, 255.0), dtype=np.uint8)
