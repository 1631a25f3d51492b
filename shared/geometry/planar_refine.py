"""Iterated reweighted Gauss-Newton on (phi, phi') over the Sampson distance, several starts at once."""

import numpy as np

from shared.geometry.planar_model import PlanarMatches, seen_along
from shared.geometry.sphere import FloatArray

RIDGE = 1e-9
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
Symmetric = tuple[FloatArray, FloatArray, FloatArray]
"""(K,) matrices of 2 x 2: both diagonal entries outside, the other one between."""


def refine(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold: float, iterations: int = 6
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Refine K models.

    Tukey's biweight, first wide (twice the threshold), then at TUKEY times the measured noise.

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
        weighted = weight * jacobian
        gradient = _sums(weighted, residual)
        step = np.clip(
            -_times(_inverse(_normal(jacobian, weighted)), gradient), -MOST_STEP_RAD, MOST_STEP_RAD
        )
        phi, phi_target = phi + step[0], phi_target + step[1]
        if i >= WIDE_STEPS - 1:
            scale = _scales(residual, weight, threshold)
    _, jacobian, weight = _linearise(matches, phi, phi_target, threshold, scale)
    a, b, d = _inverse(_normal(jacobian, weight * jacobian))
    return phi, phi_target, np.stack([a, b, b, d], axis=1).reshape(-1, 2, 2)


def _scales(residual: FloatArray, weight: FloatArray, threshold: float) -> FloatArray:
    """Width of the biweight, (K,): TUKEY standard deviations of the inliers, radians."""
    size = np.sort(np.where(weight > 0.0, np.abs(residual), np.inf), axis=1)
    middle = np.maximum(np.sum(size <= threshold, axis=1) // 2, 0)
    median = np.minimum(size[np.arange(len(size)), middle], threshold)
    return np.asarray(np.clip(TUKEY * MAD * median, 0.5 * threshold, 2.0 * threshold), dtype=np.float64)


def _linearise(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold: float, scale: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Residual e (K, N), its derivatives (2, K, N) by phi and phi', and weights (K, N).

    The derivative of the denominator matters, de = ds / n + e t.b d(t.b) / n^2: without it noise in b,
    which enters both s and ds, pulls the direction towards the crowd of features when the baseline is short.
    """
    turned = seen_along(matches, phi, phi_target)
    result = turned.evaluation(matches)
    inverse = 1.0 / result.norm
    drag = result.residual * inverse
    jacobian = np.empty((2, *result.residual.shape))
    for out, horizontal, height in (
        (jacobian[0], turned.current, -matches.z_target),
        (jacobian[1], turned.target, matches.z_current),
    ):
        np.multiply(drag, horizontal.imag, out=out)
        out += height
        out *= horizontal.real
    jacobian *= inverse
    possible = np.minimum(result.forward, result.same_side) >= -threshold
    ratio = result.residual / scale[:, None]
    weight = np.maximum(1.0 - ratio * ratio, 0.0)
    weight *= weight
    weight *= possible
    weight *= matches.weight
    return result.residual, jacobian, weight


def _sums(weighted: FloatArray, values: FloatArray) -> FloatArray:
    """Sums (2, K) over the matches of weighted derivatives times (K, N) values."""
    return np.asarray(np.einsum("ikn,kn->ik", weighted, values), dtype=np.float64)


def _normal(jacobian: FloatArray, weighted: FloatArray) -> Symmetric:
    """Normal matrices."""
    by_phi, by_target = _sums(weighted, jacobian[0]), _sums(weighted[1:], jacobian[1])
    return by_phi[0] + RIDGE, by_phi[1], by_target[0] + RIDGE


def _inverse(matrix: Symmetric) -> Symmetric:
    a, b, d = matrix
    inverse = 1.0 / (a * d - b * b)
    return d * inverse, -b * inverse, a * inverse


def _times(matrix: Symmetric, vector: FloatArray) -> FloatArray:
    a, b, d = matrix
    return np.stack([a * vector[0] + b * vector[1], b * vector[0] + d * vector[1]])
