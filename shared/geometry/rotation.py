"""The degenerate model: the camera has turned and not moved, about the vertical or about any axis."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.planar_model import PlanarMatches
from shared.geometry.sphere import BoolArray, FloatArray, wrap_rad

PAIRS = 200
"""Rotations drawn from two matches each; chosen: with half of the matches right, 50 of them are right."""
REACH = 3.0
"""Thresholds within which a turned match is an inlier: bearings that err by one threshold in both axes of
both views differ by 2 sqrt(2) = 2.83 of it."""
ROUNDS = 3
"""Refinements on the inliers of the one before; chosen: a third one hardly changes them."""


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
    mean.

    Args:
        matches: prepared matches, N >= 1.
        threshold_rad: inlier threshold of one bearing, radians.
    """
    reach = np.cos(REACH * threshold_rad)
    proposals = matches.lon_difference
    level = matches.horizontal[0] * matches.horizontal[1].conj()
    upright = matches.height[0] * matches.height[1]
    turns = np.stack([np.cos(proposals), np.sin(proposals)], axis=1)
    close = turns @ np.stack([level.real, level.imag]) >= reach - upright
    best = int(np.argmax(close.sum(axis=1)))
    yaw, mask = float(proposals[best]), close[best]
    weight = np.abs(level)  # near the poles a longitude says little
    turned = level * np.exp(-1j * yaw)
    for _ in range(ROUNDS):
        share = weight[mask]
        yaw += float(np.sum(share * np.angle(turned[mask])) / max(float(np.sum(share)), 1e-12))
        turned = level * np.exp(-1j * yaw)
        residual = np.arccos(np.clip(turned.real + upright, -1.0, 1.0))
        mask = residual <= REACH * threshold_rad
        if not mask.any():
            break
    share = weight[mask]
    spread = np.angle(turned[mask]) * share
    std = float(np.sqrt(np.sum(spread**2)) / max(float(np.sum(share)), 1e-12))
    return RotationFit(float(wrap_rad(yaw)), residual, mask, std)


def fit_rotation(
    current: FloatArray, target: FloatArray, rng: np.random.Generator, threshold_rad: float
) -> tuple[FloatArray, BoolArray]:
    """Rotation R_current_target (3, 3) that explains most of (N, 3) bearings, and its (N,) inliers.

    Two matches give a rotation (TRIAD); the best is refined by the orthogonal Procrustes problem (Wahba).
    The cosine b . R b_t of what a rotation R leaves is linear in the nine products of both bearings.
    """
    count, least = len(current), np.cos(REACH * threshold_rad)
    first = rng.integers(0, count, PAIRS)
    second = (first + rng.integers(1, count, PAIRS)) % count
    both = np.stack([current, target])
    frames, frames_target = _triad(both[:, first], both[:, second])
    products = (current[:, :, None] * target[:, None]).reshape(count, 9).T
    near = (frames @ np.swapaxes(frames_target, 1, 2)).reshape(PAIRS, 9) @ products >= least
    mask: BoolArray = near[int(np.argmax(near.sum(axis=1)))]
    rotation = np.eye(3)
    for _ in range(ROUNDS):
        u, _, vt = np.linalg.svd(current[mask].T @ target[mask])
        rotation = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
        mask = rotation.ravel() @ products >= least
    return np.asarray(rotation, dtype=np.float64), mask


def _triad(a: FloatArray, b: FloatArray) -> FloatArray:
    """Orthonormal frames (..., 3, 3), columns from two bearings (..., 3) each; useless if parallel."""
    normal = np.cross(a, b)
    normal = normal / np.maximum(np.sqrt(np.sum(normal * normal, axis=-1, keepdims=True)), 1e-12)
    return np.stack([a, normal, np.cross(a, normal)], axis=-1)
