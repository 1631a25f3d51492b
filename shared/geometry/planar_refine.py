"""Iterated reweighted Gauss-Newton on (phi, phi') over the Sampson distance, several starts at once."""

import numpy as np

from shared.geometry.angles import FloatArray
from shared.geometry.planar_model import Evaluation, PlanarMatches, evaluate

NOISE_FLOOR_RAD = 5e-4  # a twentieth of a pixel at 800 columns: quantisation, not a model of it


def noise_rad(residual: FloatArray, fitted: int = 2) -> float:
    """Standard deviation of inlier residuals (rad) after `fitted` parameters.

    Not the median: over a short baseline the fit picks the direction that makes the central residuals small,
    and the median then reads half of the true noise.
    """
    freedom = max(len(residual) - fitted, 1)
    return float(max(np.sqrt(np.sum(residual**2) / freedom), NOISE_FLOOR_RAD))


def refine(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold: float, iterations: int = 6
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
            scale = _scales(residual, weight, threshold)
    _, jacobian, weight = _linearise(matches, phi, phi_target, threshold, scale)
    return phi, phi_target, _inverse(_normal(jacobian, weight))


def _scales(residual: FloatArray, weight: FloatArray, threshold: float) -> FloatArray:
    """Width of the biweight, (K,): 4.7 robust standard deviations of the inliers, radians."""
    size = np.sort(np.where(weight > 0.0, np.abs(residual), np.inf), axis=1)
    middle = np.maximum(np.sum(size <= threshold, axis=1) // 2, 0)
    median = np.minimum(size[np.arange(len(size)), middle], threshold)
    return np.asarray(np.clip(4.7 * 1.4826 * median, 0.5 * threshold, 2.0 * threshold), dtype=np.float64)


def _linearise(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold: float, scale: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Residual e (K, N), its derivative (K, N, 2) and weights (K, N).

    The derivative of the denominator matters, de = ds / n + e t.b d(t.b) / n^2: without it noise in b,
    which enters both s and ds, pulls the direction towards the crowd of features when the baseline is short.
    """
    result = evaluate(matches, phi, phi_target)
    by_phi = _derivative(phi, matches.rows[:, :2], matches.h_current, result)
    by_target = _derivative(phi_target, matches.rows[:, 2:], matches.h_target, result)
    possible = (result.forward >= -threshold) & (result.same_side >= -threshold)
    weight = np.maximum(1.0 - (result.residual / scale[:, None]) ** 2, 0.0) ** 2 * possible * matches.weight
    return result.residual, np.stack([by_phi, by_target], axis=2), weight


def _derivative(
    angle: FloatArray, rows: FloatArray, horizontal: FloatArray, result: Evaluation
) -> FloatArray:
    """Derivative (K, N) of e by one of the two angles (K,)."""
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    denominator = (along @ horizontal.T) * (across @ horizontal.T) / result.norm
    return (across @ rows.T + result.residual * denominator) / result.norm


def _normal(jacobian: FloatArray, weight: FloatArray) -> FloatArray:
    normal: FloatArray = np.einsum("kn,kni,knj->kij", weight, jacobian, jacobian)
    return normal + 1e-9 * np.eye(2)  # a degenerate model gets a huge covariance, not an exception


def _inverse(normal: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.inv(normal), dtype=np.float64)
