"""The degenerate general model: the camera has turned about any axis and not moved."""

import numpy as np

from shared.geometry.angles import FloatArray
from shared.geometry.sphere import angle_between_rad
from shared.geometry.two_view_types import BoolArray

PAIRS = 200


def fit_rotation(
    current: FloatArray, target: FloatArray, rng: np.random.Generator, threshold_rad: float
) -> tuple[FloatArray, BoolArray]:
    """Rotation R_current_target (3, 3) that explains most of (N, 3) bearings, and its (N,) inliers.

    Two matches give a rotation (TRIAD); the best is refined by the orthogonal Procrustes problem (Wahba).
    An inlier is within three thresholds: the difference of two noisy bearings, over two axes.
    """
    count = len(current)
    first = rng.integers(0, count, PAIRS)
    second = (first + rng.integers(1, count, PAIRS)) % count
    hypotheses = _triad(current[first], current[second]) @ np.swapaxes(
        _triad(target[first], target[second]), 1, 2
    )
    dot = np.einsum("ni,hij,nj->hn", current, hypotheses, target, optimize=True)
    mask: BoolArray = dot[int(np.argmax(np.sum(dot >= np.cos(3.0 * threshold_rad), axis=1)))] >= np.cos(
        3.0 * threshold_rad
    )
    rotation = np.eye(3)
    for _ in range(3):
        u, _, vt = np.linalg.svd(current[mask].T @ target[mask])
        rotation = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
        mask = angle_between_rad(current, target @ rotation.T) <= 3.0 * threshold_rad
    return np.asarray(rotation, dtype=np.float64), mask


def _triad(a: FloatArray, b: FloatArray) -> FloatArray:
    """Orthonormal frames (H, 3, 3), columns from two bearings (H, 3) each; useless if parallel."""
    normal = np.cross(a, b)
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    return np.stack([a, normal, np.cross(a, normal)], axis=2)
