"""Angles on the circle: wrapping, differences and means, in radians."""

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

TWO_PI = 2.0 * np.pi


def wrap_rad(angle_rad: npt.ArrayLike) -> FloatArray:
    """Wrap angles of any shape to [-pi, pi), radians."""
    angle = np.asarray(angle_rad, dtype=np.float64)
    wrapped = np.mod(angle + np.pi, TWO_PI) - np.pi
    # The modulo of a tiny negative number rounds up to the modulus: keep the interval half open.
    return np.asarray(np.where(wrapped >= np.pi, -np.pi, wrapped), dtype=np.float64)


def difference_rad(a_rad: npt.ArrayLike, b_rad: npt.ArrayLike) -> FloatArray:
    """Signed shortest turn from b to a, radians in [-pi, pi), broadcast over both."""
    return wrap_rad(np.asarray(a_rad, dtype=np.float64) - np.asarray(b_rad, dtype=np.float64))


def circular_mean_rad(angles_rad: npt.ArrayLike, weights: npt.ArrayLike | None = None) -> float:
    """Direction of the (weighted) sum of unit vectors.

    Args:
        angles_rad: (N,) angles, radians, N >= 1.
        weights: (N,) non-negative weights, or None for equal weights.

    Returns:
        Mean angle in [-pi, pi), radians.

    Raises:
        ValueError: no angle, or the vectors cancel so that no mean direction exists.
    """
    angles = np.asarray(angles_rad, dtype=np.float64)
    if angles.size == 0:
        raise ValueError("angles_rad must hold at least one angle, got none")
    w = np.ones_like(angles) if weights is None else np.asarray(weights, dtype=np.float64)
    x, y = float(np.sum(w * np.cos(angles))), float(np.sum(w * np.sin(angles)))
    if np.hypot(x, y) <= 1e-12 * max(float(np.sum(np.abs(w))), 1e-300):
        raise ValueError(
            "angles_rad cancel out: the circular mean is undefined, use a median or reject the input"
        )
    return float(wrap_rad(np.arctan2(y, x)))
