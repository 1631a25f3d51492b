"""Relative poses of two views of any tilt against matches: residuals, sides, change of scale. Batched.

With rotation R (target frame seen from the current one) and unit travel t, a match of bearings b and b_t with
w = R b_t fulfils b . (t x w) = 0. As in planar_model, e = b . (t x w) / n with n^2 = |t x b|^2 + |t x w|^2 is
an angle. The triangle of both cameras and the point gives a second equation, by the law of sines:

    (1)  d_t / d_c = sin(t, b) / sin(t, w)

where d is the distance from each camera. What is seen from nearer is larger by that much, so the sizes of two
keypoints that match tell which of them is nearer, whatever the scene.

Whatever is a form b^T M b_t, as b . (t x w) with M = [t]x R and b . w with M = R, is linear in the nine
products of both bearings: one matrix product evaluates it for all poses and matches.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from shared.geometry.sphere import FloatArray, IndexArray

TINY = 1e-12
"""Keeps a division from zero; far below any bearing that a keypoint resolves."""
NEAREST_SIN = 0.03
"""Least sine in equation (1): within 2 degrees of the line of travel the ratio is noise."""
AXES = np.array(
    [
        [[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    ]
)
"""[x]x, [y]x and [z]x: matrices of the cross products with the axes."""


@dataclass(frozen=True, eq=False)
class Bearings:
    """Unit bearings (3, N) of N matches, and if known (N,) ln(size in the current view / in the target)."""

    current: FloatArray
    target: FloatArray
    log_scale: FloatArray | None = None

    def __len__(self) -> int:
        return int(self.current.shape[1])

    @cached_property
    def products(self) -> FloatArray:
        """(9, N) products of the coordinates of both bearings, in the order of a matrix (3, 3)."""
        return (self.current[:, None] * self.target).reshape(9, len(self))

    def forms(self, matrices: FloatArray) -> FloatArray:
        """b^T M b_t for matrices (..., 3, 3) of each match, (..., N)."""
        return np.asarray(matrices.reshape(*matrices.shape[:-2], 9) @ self.products, dtype=np.float64)

    def of(self, chosen: IndexArray) -> "Bearings":
        """Those matches only."""
        sizes = None if self.log_scale is None else self.log_scale[chosen]
        return Bearings(self.current[:, chosen], self.target[:, chosen], sizes)


@dataclass(frozen=True, eq=False)
class Poses:
    """K poses of the target in the current frame: (K, 3, 3) rotations and (K, 3) unit travels."""

    rotation: FloatArray
    travel: FloatArray

    def __len__(self) -> int:
        return len(self.travel)

    def of(self, chosen: IndexArray) -> "Poses":
        """Those poses only."""
        return Poses(self.rotation[chosen], self.travel[chosen])

    def opposite(self, way: FloatArray, side: FloatArray) -> "Poses":
        """Poses on the same epipolar planes, by signs (K,): the way back, half a turn about the way, or both.

        All that differs is that `forward` changes its sign with the way, `same_side` with the half turn.
        """
        half_turn = 2.0 * self.travel[:, :, None] * self.travel[:, None] - np.eye(3)
        rotation = np.where(side[:, None, None] > 0.0, self.rotation, half_turn @ self.rotation)
        return Poses(rotation, way[:, None] * self.travel)

    @property
    def heading_rad(self) -> FloatArray:
        """(K,) longitudes of the travel."""
        return np.arctan2(self.travel[:, 1], self.travel[:, 0])

    @property
    def elevation_rad(self) -> FloatArray:
        """(K,) latitudes of the travel."""
        return np.arcsin(np.clip(self.travel[:, 2], -1.0, 1.0))

    @property
    def tilt_rad(self) -> FloatArray:
        """(K,) angles between the cameras' vertical axes."""
        return np.arccos(np.clip(self.rotation[:, 2, 2], -1.0, 1.0))

    @property
    def yaw_rad(self) -> FloatArray:
        """(K,) turns about the vertical."""
        return yaw_of(self.rotation)


def yaw_of(rotation: FloatArray) -> FloatArray:
    """Turns (...,) about the vertical of the swing-twist decomposition of rotations (..., 3, 3), radians."""
    r = rotation
    return np.arctan2(r[..., 1, 0] - r[..., 0, 1], r[..., 0, 0] + r[..., 1, 1])


def upright(heading_rad: FloatArray, yaw_rad: FloatArray) -> Poses:
    """Poses of level cameras on a horizontal plane, from (K,) headings and yaws."""
    cos, sin, zero, one = np.cos(yaw_rad), np.sin(yaw_rad), np.zeros_like(yaw_rad), np.ones_like(yaw_rad)
    rotation = np.stack([cos, -sin, zero, sin, cos, zero, zero, zero, one], axis=-1).reshape(-1, 3, 3)
    travel = np.stack([np.cos(heading_rad), np.sin(heading_rad), np.zeros_like(heading_rad)], axis=-1)
    return Poses(rotation, travel)


@dataclass(frozen=True, eq=False)
class Evaluated:
    """K poses against N matches.

    Attributes:
        norm: (K, N) denominator n of the residual.
        residual: (K, N) signed angle off the epipolar plane, radians.
        forward: (K, N) normalised displacement away from t; positive where the depth is positive.
        same_side: (K, N) normalised; negative where the rays lie on opposite sides of the line of travel.
        scale_error: (K, N) ln of the size ratio less what equation (1) predicts; None without sizes.
    """

    norm: FloatArray
    residual: FloatArray
    forward: FloatArray
    same_side: FloatArray
    scale_error: FloatArray | None


def evaluate(poses: Poses, matches: Bearings) -> Evaluated:
    """Evaluate every pose on every match."""
    along = poses.travel @ matches.current
    along_turned = np.matmul(poses.travel[:, None], poses.rotation)[:, 0] @ matches.target
    sine2, sine2_turned = 1.0 - along * along, 1.0 - along_turned * along_turned
    norm = np.sqrt(np.maximum(sine2 + sine2_turned, TINY))
    inverse = 1.0 / norm
    return Evaluated(
        norm,
        matches.forms(crossing(poses.travel) @ poses.rotation) * inverse,
        (along - along_turned) * inverse,
        (matches.forms(poses.rotation) - along * along_turned) * inverse,
        None if matches.log_scale is None else matches.log_scale - _log_nearer(sine2, sine2_turned),
    )


def _log_nearer(sine2: FloatArray, sine2_turned: FloatArray) -> FloatArray:
    """ln(d_t / d_c) of equation (1), from the squared sines (K, N) of both bearings to the travel."""
    least = NEAREST_SIN**2
    nearer = np.maximum(sine2, least) / np.maximum(sine2_turned, least)
    return np.asarray(0.5 * np.log(nearer), dtype=np.float64)


def crossing(vectors: FloatArray) -> FloatArray:
    """Matrices (..., 3, 3) of the cross products with (..., 3) vectors."""
    return np.asarray((vectors @ AXES.reshape(3, 9)).reshape(*vectors.shape, 3), dtype=np.float64)
