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
    unit = np.stack([np.cos(proposals), np.sin(proposals), np.ones_like(proposals)], axis=1)
    close = unit @ matches.dot.T >= reach
    yaw = float(proposals[int(np.argmax(close.sum(axis=1)))])
    weight = np.hypot(matches.dot[:, 0], matches.dot[:, 1])  # near the poles a longitude says little
    mask = close[int(np.argmax(close.sum(axis=1)))]
    for _ in range(3):
        offset = wrap_rad(proposals - yaw)[mask]
        yaw += float(np.sum(weight[mask] * offset) / max(float(np.sum(weight[mask])), 1e-12))
        residual = _residual(matches, yaw)
        mask = residual <= 3.0 * threshold_rad
        if not mask.any():
            break
    spread = wrap_rad(proposals - yaw)[mask] * weight[mask]
    total = max(float(np.sum(weight[mask])), 1e-12)
    std = float(np.sqrt(np.sum(spread**2)) / total)
    return RotationFit(float(wrap_rad(yaw)), residual, mask, std)


def _residual(matches: PlanarMatches, yaw: float) -> FloatArray:
    dot = matches.dot @ np.array([np.cos(yaw), np.sin(yaw), 1.0])
    return np.asarray(np.arccos(np.clip(dot, -1.0, 1.0)), dtype=np.float64)
