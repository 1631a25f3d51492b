"""Two-view model of any tilt: rotation R and unit travel t with b^T [t]x R b_t = 0."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.angles import FloatArray
from shared.geometry.two_view_types import BoolArray


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
    norm = np.sqrt(np.maximum(2.0 - tb * tb - tw * tw, 1e-12))
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
        normal = (jacobian * weight[:, None]).T @ jacobian + 1e-9 * np.eye(5)
        step = np.clip(-np.linalg.solve(normal, jacobian.T @ (weight * result.residual)), -0.3, 0.3)
        travel = pose.travel + tangent @ step[3:]
        pose = Pose(_exponential(step[:3]) @ pose.rotation, travel / np.linalg.norm(travel))
        scale = threshold if i >= 3 else scale
    covariance = tangent @ np.linalg.inv(normal)[3:, 3:] @ tangent.T
    return pose, np.asarray(covariance, dtype=np.float64)


def _exponential(turn: FloatArray) -> FloatArray:
    """Rotation by the vector `turn` (Rodrigues)."""
    angle = float(np.linalg.norm(turn))
    x, y, z = turn / max(angle, 1e-300)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k), dtype=np.float64)
