"""Epipolar geometry of an upright camera that moves on a horizontal plane.

With travel at longitude phi in the current frame and phi' = phi - psi in the target frame (psi: yaw),
t = (cos phi, sin phi, 0), b the current bearing and w = Rz(psi) b_target, coplanarity b . (t x w) = 0 becomes

    (1)  s = z_t rho_c sin(mu_c - phi) - z_c rho_t sin(mu_t - phi') = 0

where (mu, rho, z) are longitude, cosine and sine of latitude. It is linear in
x = (cos phi, sin phi, cos phi', sin phi'), so all hypotheses meet all matches in one matrix product. With the
horizontal part of a bearing as the complex number h = rho e^(i mu), all that is needed of a hypothesis is
h e^(-i phi): its real part is t . b, its imaginary part rho sin(mu - phi).

    (2)  Sampson distance   e = s / n,   n^2 = |t x b|^2 + |t x w|^2

is, to first order, the noise per axis and view that explains the mismatch: an angle, well behaved at the
epipoles.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import BoolArray, FloatArray

ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class PlanarMatches:
    """Matches prepared for equation (1).

    Attributes:
        horizontal: (2, N) horizontal parts of the bearings in the current and the target frame, complex:
            x + i y.
        height: (2, N) vertical parts.
        lon_difference: (N,) mu_c - mu_t, radians.
        weight: (N,) influence of each match on the fit, (0, 1].
    """

    horizontal: ComplexArray
    height: FloatArray
    lon_difference: FloatArray
    weight: FloatArray

    @classmethod
    def from_lonlat(cls, current: FloatArray, target: FloatArray) -> "PlanarMatches":
        """Prepare (N, 2) longitudes and latitudes (rad) of both frames; all weights one."""
        both = np.stack([current, target])  # (2, N, 2)
        cos, sin = np.cos(both), np.sin(both)
        horizontal = (cos[..., 0] + 1j * sin[..., 0]) * cos[..., 1]
        return cls(horizontal, sin[..., 1], current[:, 0] - target[:, 0], np.ones(len(current)))

    def __len__(self) -> int:
        return len(self.weight)

    @property
    def rows(self) -> FloatArray:
        """(N, 4) coefficients of s over x."""
        c, t = self.horizontal * self.height[::-1]
        return np.stack([c.imag, -c.real, -t.imag, t.real], axis=1)

    def of(self, chosen: npt.NDArray[np.intp]) -> "PlanarMatches":
        """Those matches only."""
        return PlanarMatches(
            self.horizontal.take(chosen, axis=1),
            self.height.take(chosen, axis=1),
            self.lon_difference[chosen],
            self.weight[chosen],
        )

    def wrongly_paired(self, shifts: npt.NDArray[np.intp]) -> "PlanarMatches":
        """Every current bearing with the target bearing so many places on, for each of (S,) shifts."""
        count = len(self)
        first = np.tile(np.arange(count), len(shifts))
        second = ((np.arange(count) + shifts[:, None]) % count).ravel()
        return PlanarMatches(
            np.stack([self.horizontal[0, first], self.horizontal[1, second]]),
            np.stack([self.height[0, first], self.height[1, second]]),
            self.lon_difference[first],  # of no use among wrong pairs
            np.ones(len(first)),
        )


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


def evaluate(matches: PlanarMatches, directions: FloatArray) -> Evaluation:
    """Evaluate hypotheses (2, H), phi and phi' (rad), on every match."""
    return seen_along(matches, directions).evaluation(matches)


@dataclass(frozen=True, eq=False)
class Turned:
    """Horizontal parts turned so that each hypothesis travels along x, current and target, (2, H, N) each.

    Everything in equations (1) and (2), and the derivatives by phi, are products of these.

    Attributes:
        along: t . b, the real part.
        aside: rho sin(mu - phi), the imaginary part.
    """

    along: FloatArray
    aside: FloatArray

    def evaluation(self, matches: PlanarMatches) -> Evaluation:
        """Residuals and sides of (H,) hypotheses."""
        (tb, tw), (sb, sw), (z_current, z_target) = self.along, self.aside, matches.height
        norm = np.sqrt(np.maximum(2.0 - tb * tb - tw * tw, 1e-12))
        inverse = 1.0 / norm
        residual = (z_target * sb - z_current * sw) * inverse
        forward = (tb - tw) * inverse
        same_side = (sb * sw + z_current * z_target) * inverse
        return Evaluation(residual, norm, forward, same_side)


def seen_along(matches: PlanarMatches, directions: FloatArray) -> Turned:
    """Both bearings of every match as seen along (2, H) phi and phi', radians."""
    turned = np.exp(-1j * directions)[:, :, None] * matches.horizontal[:, None]
    return Turned(turned.real, turned.imag)


def line_scores(matches: PlanarMatches, directions: FloatArray, threshold_rad: float) -> FloatArray:
    """Score (H,) of lines of travel, sum of max(0, 1 - (e / threshold)^2); signs not yet told apart.

    Only this pass sees all hypotheses, so it works in single precision and on as few passes over (H, N) as
    it can.
    """
    x = np.concatenate([np.cos(directions), np.sin(directions)])[[0, 2, 1, 3]].astype(np.float32)
    gain = x.T @ matches.rows.T.astype(np.float32)
    gain *= gain
    norm2 = x[:2].T @ _columns(matches.horizontal[0])
    norm2 *= norm2
    beside = x[2:].T @ _columns(matches.horizontal[1])
    beside *= beside
    norm2 += beside
    np.subtract(np.float32(2.0), norm2, out=norm2)
    # A clip takes half the time of a maximum with a number.
    gain /= np.clip(norm2, np.float32(1e-9), np.float32(2.0), out=norm2)
    gain *= np.float32(-1.0 / threshold_rad**2)
    gain += np.float32(1.0)
    np.clip(gain, np.float32(0.0), np.float32(1.0), out=gain)
    return np.asarray(gain @ matches.weight.astype(np.float32), dtype=np.float64)


def _columns(horizontal: ComplexArray) -> npt.NDArray[np.float32]:
    """(2, N) real and imaginary parts in single precision."""
    return np.stack([horizontal.real, horizontal.imag]).astype(np.float32)


def solve_pairs(rows: FloatArray, pairs: npt.NDArray[np.intp]) -> FloatArray:
    """Both solutions of equation (1) for pairs of matches.

    Two matches give A p + B q = 0, p = (cos phi, sin phi), q = (cos phi', sin phi'); hence q = M p with
    M = -B^-1 A; |q| = |p| leaves p^T (M^T M - I) p = 0, which is cos(2 phi - beta) = -T / R.
    Where noise leaves no real root, the nearest direction (double root) is taken.

    Args:
        rows: (N, 4) of PlanarMatches.
        pairs: (P, 2) integer indices.

    Returns:
        phi and phi', (2, 2P) or fewer, radians; each stands for itself and for the opposite direction.
    """
    x0, x1, y0, y1 = rows.T
    i, j = pairs.T
    det = y0[i] * y1[j] - y1[i] * y0[j]
    keep = np.abs(det) > 1e-9  # matches on the horizon, or on one meridian, say nothing
    i, j, inverse = i[keep], j[keep], -1.0 / det[keep]
    m00 = (y1[j] * x0[i] - y1[i] * x0[j]) * inverse
    m01 = (y1[j] * x1[i] - y1[i] * x1[j]) * inverse
    m10 = (y0[i] * x0[j] - y0[j] * x0[i]) * inverse
    m11 = (y0[i] * x1[j] - y0[j] * x1[i]) * inverse
    g00, g11, cross = m00 * m00 + m10 * m10, m01 * m01 + m11 * m11, m00 * m01 + m10 * m11
    trace, half = (g00 + g11) / 2.0 - 1.0, (g00 - g11) / 2.0
    radius = np.maximum(np.hypot(half, cross), 1e-12)
    spread = np.arccos(np.clip(-trace / radius, -1.0, 1.0))
    beta = np.arctan2(cross, half)
    phi = np.stack([beta + spread, beta - spread]) / 2.0
    p0, p1 = np.cos(phi), np.sin(phi)
    phi_target = np.arctan2(m10 * p0 + m11 * p1, m00 * p0 + m01 * p1)
    return np.stack([phi.ravel(), phi_target.ravel()])
