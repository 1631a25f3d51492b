"""Essential matrix of two views of any tilt: from five matches, its poses, their residuals, refinement.

With rotation R and unit travel t, E = [t]x R, matches fulfil b^T E b_t = 0. Five of them give E (Stewenius,
Engels and Nister 2006), batched: E = x E1 + y E2 + z E3 + E4 spans the null space of the five equations; the
ten cubics det E = 0 and 2 E E^T E - tr(E E^T) E = 0 reduce to the eigenvectors of a 10 x 10 action matrix.
"""

from dataclasses import dataclass
from itertools import combinations_with_replacement, product

import numpy as np
import numpy.typing as npt

from shared.geometry.planar_refine import MOST_STEP_RAD, RIDGE
from shared.geometry.sphere import BoolArray, FloatArray

SINGULAR = 1e-18
"""Determinant below which five matches fix no matrix; chosen: above the rounding of ten factors below 1."""
REAL = 1e-8
"""Imaginary part of an eigenvalue that counts as rounding: the root of double precision."""
TINY = 1e-12
"""Keeps a division from zero; far below any bearing that a keypoint resolves."""
WIDE_STEPS = 4
"""Steps with weights twice as wide as the threshold; chosen: half of the steps."""

# Monomials of degree three in (x, y, z, 1); the last ten, all of degree below three, are the basis of the
# quotient.
_CUBICS = [m for m in combinations_with_replacement(range(4), 3) if 3 not in m]
_LOWER = [m for m in combinations_with_replacement(range(4), 3) if 3 in m]


def five_point(current: FloatArray, target: FloatArray) -> FloatArray:
    """Essential matrices of H samples of five matches.

    Args:
        current: (H, 5, 3) unit bearings, current frame.
        target: (H, 5, 3) unit bearings, target frame.

    Returns:
        (M, 3, 3) real solutions of all samples together, unit Frobenius norm, M <= 10 H.
    """
    rows = np.einsum("hki,hkj->hkij", current, target).reshape(len(current), 5, 9)
    q, _ = np.linalg.qr(np.swapaxes(rows, 1, 2), mode="complete")
    basis = np.swapaxes(q[:, :, 5:], 1, 2).reshape(-1, 4, 3, 3)
    constraints = _constraints(basis)
    left, right = constraints[:, :, :10], constraints[:, :, 10:]
    solvable = np.abs(np.linalg.det(left)) > SINGULAR
    if not solvable.any():
        return np.empty((0, 3, 3))
    action = _action(np.linalg.solve(left[solvable], right[solvable]))
    values, vectors = np.linalg.eig(action)
    x, y, z, one = (
        vectors[:, _LOWER.index(monomial), :] for monomial in ((0, 3, 3), (1, 3, 3), (2, 3, 3), (3, 3, 3))
    )
    real = (np.abs(values.imag) < REAL) & (np.abs(one) > TINY)
    safe = np.where(real, one, 1.0)
    coefficients = np.stack([x / safe, y / safe, z / safe, np.ones_like(safe)], axis=-1).real
    essential = np.einsum("hsa,haij->hsij", coefficients, basis[solvable])[real]
    return np.asarray(essential / np.linalg.norm(essential, axis=(1, 2), keepdims=True), dtype=np.float64)


def _constraints(basis: FloatArray) -> FloatArray:
    """Coefficients (H, 10, 20) of the ten cubics over the monomials _CUBICS + _LOWER."""
    outer = np.einsum("haij,hbkj->habik", basis, basis)
    trace = np.einsum("habii->hab", outer)
    cubic = 2.0 * np.einsum("habik,hckj->habcij", outer, basis) - np.einsum("hab,hcij->habcij", trace, basis)
    minors = np.cross(basis[:, :, None, 1, :], basis[:, None, :, 2, :])
    determinant = np.einsum("hai,hbci->habc", basis[:, :, 0, :], minors)
    tensor = np.concatenate([cubic.reshape(-1, 64, 9), determinant.reshape(-1, 64, 1)], axis=2)
    return np.asarray(np.einsum("hpe,pm->hem", tensor, _collect()), dtype=np.float64)


def _collect() -> FloatArray:
    """(64, 20) matrix that adds up the coefficients of equal monomials."""
    table = np.zeros((64, 20))
    monomials = _CUBICS + _LOWER
    for row, triple in enumerate(product(range(4), repeat=3)):
        table[row, monomials.index(_sorted(triple))] = 1.0
    return table


def _action(reduced: FloatArray) -> FloatArray:
    """Matrix (H, 10, 10) of the multiplication by x on the basis _LOWER, from cubic = -reduced @ lower."""
    action = np.zeros_like(reduced)
    for row, monomial in enumerate(_LOWER):
        raised = list(monomial)
        raised.remove(3)
        product_x = _sorted((*raised, 0))
        if product_x in _CUBICS:
            action[:, row, :] = -reduced[:, _CUBICS.index(product_x), :]
        else:
            action[:, row, _LOWER.index(product_x)] = 1.0
    return action


def _sorted(triple: tuple[int, ...]) -> tuple[int, int, int]:
    a, b, c = sorted(triple)
    return a, b, c


def draw_fives(count: int, samples: int, rng: np.random.Generator) -> npt.NDArray[np.intp]:
    """(samples, 5) indices, all different within a row."""
    return np.argsort(rng.random((samples, count)), axis=1)[:, :5]


@dataclass(frozen=True, eq=False)
class Pose:
    """Target in the current frame: rotation R_current_target (3, 3) and unit direction of travel t (3,)."""

    rotation: FloatArray
    travel: FloatArray


@dataclass(frozen=True, eq=False)
class PoseEvaluation:
    """One pose against N matches, each (N,): see planar_model.Evaluation for the meaning."""

    residual: FloatArray
    norm: FloatArray
    forward: FloatArray
    same_side: FloatArray

    def consistent(self, threshold_rad: float) -> BoolArray:
        """Inliers: near the epipolar plane and in front of both cameras within the noise."""
        near = np.abs(self.residual) <= threshold_rad
        return near & (self.same_side >= -threshold_rad) & (self.forward >= -threshold_rad)


def evaluate_pose(pose: Pose, current: FloatArray, target: FloatArray) -> PoseEvaluation:
    """Sampson residual and cheirality of (N, 3) bearings of both frames."""
    turned = target @ pose.rotation.T
    tb, tw = current @ pose.travel, turned @ pose.travel
    norm = np.sqrt(np.maximum(2.0 - tb * tb - tw * tw, TINY))
    residual = np.sum(current * np.cross(pose.travel, turned), axis=1) / norm
    dot = np.sum(current * turned, axis=1)
    return PoseEvaluation(residual, norm, (tb - tw) / norm, (dot - tb * tw) / norm)


def score_essentials(
    essentials: FloatArray, current: FloatArray, target: FloatArray, threshold: float
) -> FloatArray:
    """Truncated Sampson score (M,) of (M, 3, 3) essential matrices on (N, 3) bearings, single precision."""
    e = essentials.astype(np.float32)
    b, bt = current.astype(np.float32), target.astype(np.float32)
    right = e @ bt.T
    left = np.swapaxes(e, 1, 2) @ b.T
    s = np.einsum("min,ni->mn", right, b)
    norm2 = np.einsum("min,min->mn", right, right) + np.einsum("min,min->mn", left, left)
    gain = np.maximum(1.0 - s * s / (np.maximum(norm2, 1e-9) * np.float32(threshold**2)), 0.0)
    return np.asarray(gain.sum(axis=1), dtype=np.float64)


def poses_of(essential: FloatArray) -> list[Pose]:
    """The four poses of an essential matrix (Hartley and Zisserman, 9.6.2)."""
    u, _, vt = np.linalg.svd(essential)
    u, vt = u * np.linalg.det(u), vt * np.linalg.det(vt)
    w = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    return [Pose(u @ turn @ vt, sign * u[:, 2]) for turn in (w, w.T) for sign in (1.0, -1.0)]


def refine_pose(
    pose: Pose, current: FloatArray, target: FloatArray, threshold: float, iterations: int = 8
) -> tuple[Pose, FloatArray]:
    """Reweighted Gauss-Newton over R and t; also the (3, 3) covariance of t for unit noise."""
    scale, normal, tangent = 2.0 * threshold, np.eye(5), np.eye(3)[:, :2]
    for i in range(iterations):
        result = evaluate_pose(pose, current, target)
        turned = target @ pose.rotation.T
        tangent = np.linalg.svd(pose.travel[None, :])[2][1:].T
        by_turn = np.cross(turned, np.cross(current, pose.travel))
        by_travel = np.cross(turned, current) @ tangent
        jacobian = np.concatenate([by_turn, by_travel], axis=1) / result.norm[:, None]
        possible = (result.forward >= -threshold) & (result.same_side >= -threshold)
        weight = np.maximum(1.0 - (result.residual / scale) ** 2, 0.0) ** 2 * possible
        normal = (jacobian * weight[:, None]).T @ jacobian + RIDGE * np.eye(5)
        step = np.clip(
            -np.linalg.solve(normal, jacobian.T @ (weight * result.residual)), -MOST_STEP_RAD, MOST_STEP_RAD
        )
        travel = pose.travel + tangent @ step[3:]
        pose = Pose(_exponential(step[:3]) @ pose.rotation, travel / np.linalg.norm(travel))
        scale = threshold if i >= WIDE_STEPS - 1 else scale
    covariance = tangent @ np.linalg.inv(normal)[3:, 3:] @ tangent.T
    return pose, np.asarray(covariance, dtype=np.float64)


def _exponential(turn: FloatArray) -> FloatArray:
    """Rotation by the vector `turn` (Rodrigues)."""
    angle = float(np.linalg.norm(turn))
    x, y, z = turn / max(angle, 1e-300)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k), dtype=np.float64)
