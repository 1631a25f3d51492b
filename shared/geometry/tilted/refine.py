"""Reweighted Gauss-Newton over rotation and travel of several poses at once, with level cameras preferred."""

from collections.abc import Sequence

import numpy as np

from shared.geometry.sphere import FloatArray
from shared.geometry.tilted.match_evidence import CLIMB_RAD, TILT_RAD, motion_ratio
from shared.geometry.tilted.poses import AXES, Bearings, Evaluated, Poses, crossing, evaluate

MOST_STEP_RAD = 0.2
"""Longest step; chosen: 11 degrees, so that no step leaves the start that it refines."""
RIDGE = 1e-3
"""Added to the normal matrix, whose entries are matches over squared noise: far below one match."""
PRIOR = np.diag([TILT_RAD**-2, TILT_RAD**-2, 0.0, 0.0, CLIMB_RAD**-2]) + RIDGE * np.eye(5)
"""Information that level cameras are usual, for a turn about x, y, z and the travel sideways and upwards."""
LEAST_NOISE_RAD, MOST_NOISE_RAD = float(np.deg2rad(0.05)), float(np.deg2rad(0.5))
"""Bounds of the measured noise: a fifth of a pixel at 1600 columns; more means wrong matches."""


def refine(
    poses: Poses,
    matches: Bearings,
    right: FloatArray,
    noises_rad: Sequence[float],
    *,
    measured: int = 0,
) -> tuple[Poses, FloatArray]:
    """Maximum a posteriori poses, by expectation maximisation.

    Every match counts with the probability that it belongs to the pose; a tilt between the cameras and a
    climb are pulled towards none, as their usual sizes tell.

    Args:
        poses: K starts.
        matches: N matches.
        right: (N,) probability that each is right.
        noises_rad: noise assumed in each step, from wide to narrow.
        measured: further steps with the noise that the pose itself leaves.

    Returns:
        The poses and (K, 5, 5) information, inverse to the covariances of a turn about x, y, z and of the
        travel sideways and upwards.
    """
    information = np.zeros((len(poses), 5, 5))
    for k in range(len(noises_rad) + measured):
        seen = evaluate(poses, matches)
        usual = noises_rad[min(k, len(noises_rad) - 1)]
        ratio = motion_ratio(seen, usual)
        belongs = right * ratio / (1.0 - right + right * ratio)
        noise = _noise(seen, belongs) if k >= len(noises_rad) else np.full(len(poses), usual)
        poses, information = _step(poses, matches, seen, belongs, noise)
    return poses, information


def _noise(seen: Evaluated, belongs: FloatArray) -> FloatArray:
    """Spread (K,) of the residuals of what belongs to each pose, after its five parameters."""
    freedom = np.maximum(belongs.sum(axis=1) - 5.0, 1.0)
    spread = np.sqrt(np.sum(belongs * seen.residual**2, axis=1) / freedom)
    return np.asarray(np.clip(spread, LEAST_NOISE_RAD, MOST_NOISE_RAD), dtype=np.float64)


def _step(
    poses: Poses, matches: Bearings, seen: Evaluated, belongs: FloatArray, noise: FloatArray
) -> tuple[Poses, FloatArray]:
    t = poses.travel
    by_travel = crossing(t)
    sideways = t @ AXES[2].T / np.maximum(np.hypot(t[:, 0], t[:, 1]), 1e-9)[:, None]
    across = np.stack([sideways, np.matmul(by_travel, sideways[:, :, None])[:, :, 0]], axis=1)
    changes = np.concatenate([by_travel[:, None] @ AXES, crossing(across)], axis=1) @ poses.rotation[:, None]
    jacobian = matches.forms(changes)
    weighted = jacobian * (belongs / (noise[:, None] * seen.norm) ** 2)[:, None, :]
    normal = np.matmul(weighted, np.swapaxes(jacobian, 1, 2)) + PRIOR
    gradient = np.matmul(weighted, (seen.residual * seen.norm)[:, :, None])[:, :, 0]
    # The target's vertical in the current frame is R e_z = w x e_z for a small tilt w: w = (-y, x).
    gradient[:, 0] -= poses.rotation[:, 1, 2] * TILT_RAD**-2
    gradient[:, 1] += poses.rotation[:, 0, 2] * TILT_RAD**-2
    gradient[:, 4] += poses.elevation_rad * CLIMB_RAD**-2
    step = -np.linalg.solve(normal, gradient[:, :, None])[:, :, 0]
    step = np.minimum(np.maximum(step, -MOST_STEP_RAD), MOST_STEP_RAD)
    moved = t + np.matmul(step[:, None, 3:], across)[:, 0]
    moved /= np.sqrt(np.sum(moved * moved, axis=1, keepdims=True))
    return Poses(np.matmul(exponential(step[:, :3]), poses.rotation), moved), normal


def exponential(turns: FloatArray) -> FloatArray:
    """Rotations (K, 3, 3) by (K, 3) vectors (Rodrigues)."""
    angle = np.sqrt(np.sum(turns * turns, axis=1, keepdims=True))
    k = crossing(turns / np.maximum(angle, 1e-300))
    sin, cos = np.sin(angle)[:, :, None], np.cos(angle)[:, :, None]
    return np.asarray(np.eye(3) + sin * k + (1.0 - cos) * (k @ k), dtype=np.float64)
