"""Epipolar geometry of an upright camera that moves on a horizontal plane.

With travel at longitude phi in the current frame and phi' = phi - psi in the target frame (psi: yaw),
t = (cos phi, sin phi, 0), b the current bearing and w = Rz(psi) b_target, coplanarity b . (t x w) = 0 becomes

    (1)  s = z_t rho_c sin(mu_c - phi) - z_c rho_t sin(mu_t - phi') = 0

where (mu, rho, z) are longitude, cosine and sine of latitude. It is linear in
x = (cos phi, sin phi, cos phi', sin phi'), so all hypotheses meet all matches in one matrix product.

    (2)  Sampson distance   e = s / n,   n^2 = |t x b|^2 + |t x w|^2

is, to first order, the noise per axis and view that explains the mismatch: an angle, well behaved at the
epipoles.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.geometry.angles import FloatArray
from shared.geometry.two_view_types import BoolArray


@dataclass(frozen=True, eq=False)
class PlanarMatches:
    """Matches prepared for equation (1).

    Attributes:
        rows: (N, 4) coefficients of s over x.
        h_current: (N, 2) horizontal part of the current bearings.
        h_target: (N, 2) horizontal part of the target bearings.
        dot: (N, 3) coefficients of b . w over (cos psi, sin psi, 1).
        lon_difference: (N,) mu_c - mu_t, radians.
        weight: (N,) influence of each match on the fit, (0, 1].
    """

    rows: FloatArray
    h_current: FloatArray
    h_target: FloatArray
    dot: FloatArray
    lon_difference: FloatArray
    weight: FloatArray

    @classmethod
    def from_lonlat(cls, current: FloatArray, target: FloatArray) -> "PlanarMatches":
        """Prepare (N, 2) longitudes and latitudes (rad) of both frames; all weights one."""
        mu_c, mu_t = current[:, 0], target[:, 0]
        rho_c, rho_t = np.cos(current[:, 1]), np.cos(target[:, 1])
        z_c, z_t = np.sin(current[:, 1]), np.sin(target[:, 1])
        h_c = np.stack([rho_c * np.cos(mu_c), rho_c * np.sin(mu_c)], axis=1)
        h_t = np.stack([rho_t * np.cos(mu_t), rho_t * np.sin(mu_t)], axis=1)
        rows = np.stack([z_t * h_c[:, 1], -z_t * h_c[:, 0], -z_c * h_t[:, 1], z_c * h_t[:, 0]], axis=1)
        delta = mu_c - mu_t
        dot = np.stack([rho_c * rho_t * np.cos(delta), rho_c * rho_t * np.sin(delta), z_c * z_t], axis=1)
        return cls(rows, h_c, h_t, dot, delta, np.ones(len(rows)))


@dataclass(frozen=True, eq=False)
class Evaluation:
    """H hypotheses against N matches, all (H, N).

    Attributes:
        residual: signed Sampson distance, radians, equation (2).
        norm: its denominator n.
        forward: normalised displacement away from t; positive where the depth is positive for +t.
        same_side: normalised; negative where the two rays lie on opposite sides of the line of travel,
            which no point can do for either sign of t.
    """

    residual: FloatArray
    norm: FloatArray
    forward: FloatArray
    same_side: FloatArray

    def consistent(self, threshold_rad: float) -> tuple[BoolArray, BoolArray]:
        """Inliers for +t and for -t, (H, N) each: near the plane and, within the noise, in front."""
        base = (np.abs(self.residual) <= threshold_rad) & (self.same_side >= -threshold_rad)
        return base & (self.forward >= -threshold_rad), base & (self.forward <= threshold_rad)


def evaluate(matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray) -> Evaluation:
    """Evaluate hypotheses (H,) phi and (H,) phi' (rad) on every match."""
    c, s = np.cos(phi), np.sin(phi)
    ct, st = np.cos(phi_target), np.sin(phi_target)
    x = np.stack([c, s, ct, st], axis=1)
    tb = x[:, :2] @ matches.h_current.T
    tw = x[:, 2:] @ matches.h_target.T
    norm = np.sqrt(np.maximum(2.0 - tb * tb - tw * tw, 1e-12))
    # cos and sin of psi = phi - phi' by the addition theorems
    psi = np.stack([c * ct + s * st, s * ct - c * st, np.ones_like(c)], axis=1)
    inverse = 1.0 / norm
    residual = (x @ matches.rows.T) * inverse
    forward = (tb - tw) * inverse
    same_side = (psi @ matches.dot.T - tb * tw) * inverse
    return Evaluation(residual, norm, forward, same_side)


def line_scores(
    matches: PlanarMatches, phi: FloatArray, phi_target: FloatArray, threshold_rad: float
) -> FloatArray:
    """Score (H,) of lines of travel, sum of max(0, 1 - (e / threshold)^2); signs not yet told apart.

    Only this pass sees all hypotheses, so it works in single precision and on as few passes over (H, N) as
    it can.
    """
    x = np.stack([np.cos(phi), np.sin(phi), np.cos(phi_target), np.sin(phi_target)], axis=1).astype(
        np.float32
    )
    gain = x @ matches.rows.T.astype(np.float32)
    gain *= gain
    tb = x[:, :2] @ matches.h_current.T.astype(np.float32)
    tb *= tb
    tw = x[:, 2:] @ matches.h_target.T.astype(np.float32)
    tw *= tw
    tb += tw
    np.subtract(2.0, tb, out=tb)
    np.maximum(tb, np.float32(1e-9), out=tb)
    gain /= tb
    gain *= np.float32(-1.0 / threshold_rad**2)
    gain += np.float32(1.0)
    np.maximum(gain, np.float32(0.0), out=gain)
    return np.asarray(gain @ matches.weight.astype(np.float32), dtype=np.float64)


def solve_pairs(rows: FloatArray, pairs: npt.NDArray[np.intp]) -> tuple[FloatArray, FloatArray]:
    """Both solutions of equation (1) for pairs of matches.

    Two matches give A p + B q = 0, p = (cos phi, sin phi), q = (cos phi', sin phi'); hence q = M p with
    M = -B^-1 A; |q| = |p| leaves p^T (M^T M - I) p = 0, which is cos(2 phi - beta) = -T / R.
    Where noise leaves no real root, the nearest direction (double root) is taken.

    Args:
        rows: (N, 4) of PlanarMatches.
        pairs: (P, 2) integer indices.

    Returns:
        phi and phi', (2P,) or fewer, radians; each stands for itself and for the opposite direction.
    """
    a, b = rows[pairs][:, :, :2], rows[pairs][:, :, 2:]
    det = b[:, 0, 0] * b[:, 1, 1] - b[:, 0, 1] * b[:, 1, 0]
    keep = np.abs(det) > 1e-9  # matches on the horizon, or on one meridian, say nothing
    a, b, det = a[keep], b[keep], det[keep]
    adjugate = np.empty_like(b)
    adjugate[:, 0, 0], adjugate[:, 1, 1] = b[:, 1, 1], b[:, 0, 0]
    adjugate[:, 0, 1], adjugate[:, 1, 0] = -b[:, 0, 1], -b[:, 1, 0]
    m = -(adjugate @ a) / det[:, None, None]
    g = np.swapaxes(m, 1, 2) @ m
    trace, half, cross = (g[:, 0, 0] + g[:, 1, 1]) / 2.0 - 1.0, (g[:, 0, 0] - g[:, 1, 1]) / 2.0, g[:, 0, 1]
    radius = np.maximum(np.hypot(half, cross), 1e-12)
    spread = np.arccos(np.clip(-trace / radius, -1.0, 1.0))
    beta = np.arctan2(cross, half)
    phi = np.concatenate([beta + spread, beta - spread]) / 2.0
    q = np.concatenate([m, m]) @ np.stack([np.cos(phi), np.sin(phi)], axis=1)[:, :, None]
    return phi, np.arctan2(q[:, 1, 0], q[:, 0, 0])
