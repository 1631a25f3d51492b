"""Relative poses of two views of any tilt against matches: residuals, sides, change of scale. Batched.

With rotation R (target frame seen from the current one) and unit travel t, a match of bearings b and b_t with
w = R b_t fulfils b . (t x w) = 0. As in planar_model, e = b . (t x w) / n with n^2 = |t x b|^2 + |t x w|^2 is
an angle. The triangle of both cameras and the point gives a second equation, by the law of sines:

    (1)  d_t / d_c = sin(t, b) / sin(t, w)

where d is the distance from each camera. What is seen from nearer is larger by that much, so the sizes of two
keypoints that match tell which of them is nearer, whatever the scene.
"""

from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import FloatArray, IndexArray

TINY = 1e-12
"""Keeps a division from zero; far below any bearing that a keypoint resolves."""
NEAREST_SIN = 0.03
"""Least sine in equation (1): within 2 degrees of the line of travel the ratio is noise."""


@dataclass(frozen=True, eq=False)
class Bearings:
    """Unit bearings (3, N) of N matches, and if known (N,) ln(size in the current view / in the target)."""

    current: FloatArray
    target: FloatArray
    log_scale: FloatArray | None = None

    def __len__(self) -> int:
        return int(self.current.shape[1])

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
        turned: (K, 3, N) target bearings in the current frame.
        norm: (K, N) denominator n of the residual.
        residual: (K, N) signed angle off the epipolar plane, radians.
        forward: (K, N) normalised displacement away from t; positive where the depth is positive.
        same_side: (K, N) normalised; negative where the rays lie on opposite sides of the line of travel.
        scale_error: (K, N) ln of the size ratio less what equation (1) predicts; None without sizes.
    """

    turned: FloatArray
    norm: FloatArray
    residual: FloatArray
    forward: FloatArray
    same_side: FloatArray
    scale_error: FloatArray | None


def evaluate(poses: Poses, matches: Bearings) -> Evaluated:
    """Evaluate every pose on every match."""
    b, t = matches.current, poses.travel
    turned = (poses.rotation.reshape(-1, 3) @ matches.target).reshape(len(poses), 3, -1)
    along = t @ b
    along_turned = np.matmul(t[:, None, :], turned)[:, 0]
    norm = np.sqrt(np.maximum(2.0 - along * along - along_turned * along_turned, TINY))
    inverse = 1.0 / norm
    plane = cross(t[:, :, None], turned)
    residual = (b[0] * plane[:, 0] + b[1] * plane[:, 1] + b[2] * plane[:, 2]) * inverse
    dot = b[0] * turned[:, 0] + b[1] * turned[:, 1] + b[2] * turned[:, 2]
    return Evaluated(
        turned,
        norm,
        residual,
        (along - along_turned) * inverse,
        (dot - along * along_turned) * inverse,
        None if matches.log_scale is None else matches.log_scale - _log_nearer(along, along_turned),
    )


def _log_nearer(along: FloatArray, along_turned: FloatArray) -> FloatArray:
    """ln(d_t / d_c) of equation (1), from the cosines (K, N) of both bearings to the travel."""
    sine2 = np.maximum(1.0 - along * along, NEAREST_SIN**2)
    sine2_turned = np.maximum(1.0 - along_turned * along_turned, NEAREST_SIN**2)
    return np.asarray(0.5 * np.log(sine2 / sine2_turned), dtype=np.float64)


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross product along axis 1 of (K, 3, N) arrays that broadcast; thrice as fast as numpy's own."""
    x = a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1]
    out = np.empty((len(x), 3, *x.shape[1:]))
    out[:, 0] = x
    out[:, 1] = a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]
    out[:, 2] = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return out
