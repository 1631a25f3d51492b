"""Iterated reweighted Gauss-Newton on (phi, phi') over the Sampson distance, several starts at once."""

import numpy as np

from shared.geometry.planar_model import PlanarMatches, seen_along
from shared.geometry.sphere import FloatArray

RIDGE = 1e-9 * np.eye(2)[:, :, None]
"""Added to the normal matrix, whose entries are of the order of 1 per match: a degenerate model gets a huge
covariance, not an exception."""
MOST_STEP_RAD = 0.3
"""Longest Gauss-Newton step; chosen: 17 degrees, so that no step leaves the start that it refines."""
WIDE_STEPS = 3
"""Steps with the wide weights, before the measured noise sets them; chosen: half of the steps."""
TUKEY = 4.7
"""Width of the biweight in standard deviations, 4.685 for 95 % efficiency (Holland and Welsch 1977)."""
MAD = 1.4826
"""Standard deviation of normal noise over its median absolute deviation."""
COFACTOR_SIGNS = np.array([[[1.0], [-1.0]], [[-1.0], [1.0]]])
HEIGHT_SIGNS = np.array([[[-1.0]], [[1.0]]])
"""Signs of z_t and z_c in the derivatives of equation (1) of planar_model by phi and phi'."""


def refine(
    matches: PlanarMatches, directions: FloatArray, threshold: float, iterations: int = 6
) -> tuple[FloatArray, FloatArray]:
    """Refine K models.

    Tukey's biweight, first wide (twice the threshold), then at TUKEY times the measured noise.

    Args:
        matches: prepared matches.
        directions: (2, K) start, phi and phi', radians, sign already chosen.
        threshold: inlier threshold, radians.
        iterations: Gauss-Newton steps.

    Returns:
        Refined directions (2, K), and (2, 2, K) covariances of both for unit noise.
    """
    scale = np.full(directions.shape[1], 2.0 * threshold)
    for i in range(iterations):
        residual, jacobian, weight = _linearise(matches, directions, threshold, scale)
        weighted = weight * jacobian
        gradient = np.einsum("ikn,kn->ik", weighted, residual)
        step = -np.einsum("ijk,jk->ik", _inverse(_normal(jacobian, weighted)), gradient)
        directions = directions + np.minimum(np.maximum(step, -MOST_STEP_RAD), MOST_STEP_RAD)
        if i >= WIDE_STEPS - 1:
            scale = _scales(residual, weight, threshold)
    _, jacobian, weight = _linearise(matches, directions, threshold, scale)
    return directions, _inverse(_normal(jacobian, weight * jacobian))


def _scales(residual: FloatArray, weight: FloatArray, threshold: float) -> FloatArray:
    """Width of the biweight, (K,): TUKEY standard deviations of the inliers, radians."""
    size = np.sort(np.where(weight > 0.0, np.abs(residual), np.inf), axis=1)
    middle = np.maximum(np.sum(size <= threshold, axis=1) // 2, 0)
    median = np.minimum(size[np.arange(len(size)), middle], threshold)
    return np.asarray(np.clip(TUKEY * MAD * median, 0.5 * threshold, 2.0 * threshold), dtype=np.float64)


def _linearise(
    matches: PlanarMatches, directions: FloatArray, threshold: float, scale: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Residual e (K, N), its derivatives (2, K, N) by phi and phi', and weights (K, N).

    The derivative of the denominator matters, de = ds / n + e t.b d(t.b) / n^2: without it noise in b,
    which enters both s and ds, pulls the direction towards the crowd of features when the baseline is short.
    """
    turned = seen_along(matches, directions)
    result = turned.evaluation(matches)
    inverse = 1.0 / result.norm
    jacobian = (result.residual * inverse) * turned.aside
    jacobian += HEIGHT_SIGNS * matches.height[::-1, None]
    jacobian *= turned.along
    jacobian *= inverse
    possible = np.minimum(result.forward, result.same_side) >= -threshold
    ratio = result.residual / scale[:, None]
    weight = np.maximum(1.0 - ratio * ratio, 0.0)
    weight *= weight
    weight *= possible
    weight *= matches.weight
    return result.residual, jacobian, weight


def _normal(jacobian: FloatArray, weighted: FloatArray) -> FloatArray:
    """Normal matrices (2, 2, K)."""
    return np.asarray(np.einsum("ikn,jkn->ijk", weighted, jacobian) + RIDGE, dtype=np.float64)


def _inverse(matrices: FloatArray) -> FloatArray:
    """Inverse of symmetric (2, 2, K)."""
    (a, b), (_, d) = matrices
    return np.asarray(COFACTOR_SIGNS * matrices[::-1, ::-1] / (a * d - b * b), dtype=np.float64)
