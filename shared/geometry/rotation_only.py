"""The degenerate model: the camera has turned about the vertical and not moved."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.angles import FloatArray, wrap_rad
from shared.geometry.planar_model import PlanarMatches
from shared.geometry.two_view_types import BoolArray


@dataclass(frozen=True, eq=False)
class RotationFit:
    """Best yaw (rad), (N,) residuals after it (rad), (N,) inliers, and the spread of the yaw (rad)."""

    yaw_rad: float
    residual_rad: FloatArray
    mask: BoolArray
    std_rad: float


def fit_yaw(matches: PlanarMatches, threshold_rad: float) -> RotationFit:
    """Yaw that brings most target bearings within reach of their current bearing.

    Every match proposes its own longitude difference; the best proposal is refined as a weighted circular
    mean. An inlier is within three thresholds: the difference of two noisy bearings, over two axes.

    Args:
        matches: prepared matches, N >= 1.
        threshold_rad: inlier threshold of one bearing, radians.
    """
    reach = np.cos(3.0 * threshold_rad)
    proposals = matches.lon_difference
    level = matches.h_current * matches.h_target.conj()
    upright = matches.z_current * matches.z_target
    close = np.multiply.outer(np.exp(-1j * proposals), level).real >= reach - upright
    best = int(np.argmax(close.sum(axis=1)))
    yaw, mask = float(proposals[best]), close[best]
    weight = np.abs(level)  # near the poles a longitude says little
    turned = level * np.exp(-1j * yaw)
    for _ in range(3):
        share = weight[mask]
        yaw += float(np.sum(share * np.angle(turned[mask])) / max(float(np.sum(share)), 1e-12))
        turned = level * np.exp(-1j * yaw)
        residual = np.arccos(np.clip(turned.real + upright, -1.0, 1.0))
        mask = residual <= 3.0 * threshold_rad
        if not mask.any():
            break
    share = weight[mask]
    spread = np.angle(turned[mask]) * share
    std = float(np.sqrt(np.sum(spread**2)) / max(float(np.sum(share)), 1e-12))
    return RotationFit(float(wrap_rad(yaw)), residual, mask, std)
