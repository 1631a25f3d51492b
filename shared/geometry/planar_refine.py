"""Iterated reweighted Gauss-Newton on (phi, phi') over the Sampson distance, several starts at once."""

import numpy as np

from shared.geometry.angles import FloatArray
from shared.geometry.planar_model import PlanarMatches, evaluate

NOISE_FLOOR_RAD = 5e-4  # a twentieth of a pixel at 800 columns: quantisation, not a model of it


def noise_rad(residual: FloatArray, threshold: float) -> float:
    """Robust standard deviation of inlier residuals (rad): 1.4826 median |e|, within floor and threshold."""
    if len(residual) == 0:
        return threshold
    return float(np.clip(1.4826 * np.median(np.abs(residual)), NOISE_FLOOR_RAD, threshold))


def refine(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold: float, iterations: int = 8
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Refine K models.

    Tukey's biweight, first wide (twice the threshold), then at 4.7 times the measured noise.

    Args:
        matches: prepared matches.
        phi: (K,) start, radians, sign already chosen.
        phi_target: (K,) start, radians.
        threshold: inlier threshold, radians.
        iterations: Gauss-Newton steps.

    Returns:
        Refined phi (K,) and phi' (K,), and (K, 2, 2) covariances of both for unit noise.
    """
    scale = np.full(len(phi), 2.0 * threshold)
    for i in range(iterations):
        residual, jacobian, weight = _linearise(matches, phi, phi_target, threshold, scale)
        normal = _normal(jacobian, weight)
        gradient = np.einsum("kn,kni,kn->ki", weight, jacobian, residual)
        step = np.clip(-(_inverse(normal) @ gradient[:, :, None])[:, :, 0], -0.3, 0.3)
        phi, phi_target = phi + step[:, 0], phi_target + step[:, 1]
        if i >= 2:
            scale = np.array([_scale(r, w, threshold) for r, w in zip(residual, weight, strict=True)])
    _, jacobian, weight = _linearise(matches, phi, phi_target, threshold, scale)
    return phi, phi_target, _inverse(_normal(jacobian, weight))


def _scale(residual: FloatArray, weight: FloatArray, threshold: float) -> float:
    inner = residual[(weight > 0.0) & (np.abs(residual) <= threshold)]
    return float(np.clip(4.7 * noise_rad(inner, threshold), 0.5 * threshold, 2.0 * threshold))


def _linearise(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold: float, scale: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Residual (K, N), its derivative (K, N, 2) with the denominator held, and weights (K, N)."""
    result = evaluate(matches, phi, phi_target)
    by_phi = np.stack([-np.sin(phi), np.cos(phi)], axis=1) @ matches.rows[:, :2].T / result.norm
    by_target = np.stack([-np.sin(phi_target), np.cos(phi_target)], axis=1) @ matches.rows[:, 2:].T / result.norm
    possible = (result.forward >= -threshold) & (result.same_side >= -threshold)
    weight = np.maximum(1.0 - (result.residual / scale[:, None]) ** 2, 0.0) ** 2 * possible
    return result.residual, np.stack([by_phi, by_target], axis=2), weight


def _normal(jacobian: FloatArray, weight: FloatArray) -> FloatArray:
    normal: FloatArray = np.einsum("kn,kni,knj->kij", weight, jacobian, jacobian)
    return normal + 1e-9 * np.eye(2)  # a degenerate model gets a huge covariance, not an exception


def _inverse(normal: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.inv(normal), dtype=np.float64)
