"""Which keypoints of two panoramas are the same point: by their ranges, exactly. Pure."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from experiments.training.sights import BoolArray, Sight, projected
from services.features.pipeline.interfaces import IndexArray
from shared.geometry.sphere import FloatArray, bearings_from_lonlat

RIGHT_RAD = float(np.deg2rad(1.0))
"""A match is right within this: 2.2 pixels at 800 columns, a little more than verification allows (0.7)."""


@dataclass(frozen=True, eq=False)
class Correspondences:
    """What is true of the keypoints of two panoramas.

    Attributes:
        off_rad: (N, M) angle between where keypoint n of the first is in the second, and keypoint m there.
        visible: (N,) keypoints of the first that can be seen from the second.
    """

    off_rad: FloatArray
    visible: BoolArray

    @property
    def recurring(self) -> BoolArray:
        """(N,) keypoints of the first that are seen and found in the second."""
        if not self.off_rad.shape[1]:
            return np.zeros_like(self.visible)
        return np.asarray(self.visible & (self.off_rad.min(axis=1) <= RIGHT_RAD))

    @property
    def pairs(self) -> IndexArray:
        """(K, 2) one partner each: those nearest to one another that are within `RIGHT_RAD`."""
        rows = np.flatnonzero(self.recurring)
        if not len(rows):
            return np.zeros((0, 2), np.intp)
        nearest = self.off_rad[rows].argmin(axis=1)
        seen = np.where(self.visible[:, None], self.off_rad, np.inf)
        mutual = seen.argmin(axis=0)[nearest] == rows
        return np.stack([rows[mutual], nearest[mutual]], axis=1)

    def right(self, pairs: IndexArray) -> BoolArray:
        """(K,) which of (K, 2) matches are right."""
        first, second = pairs[:, 0], pairs[:, 1]
        return np.asarray(self.visible[first] & (self.off_rad[first, second] <= RIGHT_RAD))


def correspondences(
    first_rad: npt.ArrayLike, second_rad: npt.ArrayLike, here: Sight, there: Sight
) -> Correspondences:
    """What is true of keypoints at (N, 2) and (M, 2) longitudes and latitudes of two panoramas, radians."""
    expected, visible = projected(first_rad, here, there)
    second = np.asarray(second_rad, np.float64).reshape(-1, 2)
    cosine = bearings_from_lonlat(expected) @ bearings_from_lonlat(second).T
    return Correspondences(np.arccos(np.clip(cosine, -1.0, 1.0)), visible)
