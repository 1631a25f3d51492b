"""Pairs of matches for methods 1 and 2: bisectors with their signs, equations (2.1) to (2.6)."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.angles import FloatArray, wrap_rad

# Rounding of a dot product: below it two angles are equal. Without it identical frames would vote by
# rounding errors.
TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class PairVotes:
    """One row per unordered pair i < j (Q6), in the order of numpy.triu_indices.

    Attributes:
        directions: (P, 2) signed bisectors u_ij of equation (2.6); zero where a pair is antipodal (Q4).
        growth_rad: (P,) change of the pair's longitude difference, equation (2.9), radians.
    """

    directions: FloatArray
    growth_rad: FloatArray


def pair_votes(current: FloatArray, target: FloatArray) -> PairVotes:
    """Votes of all pairs of matches.

    Longitude differences are wrapped to [0, pi] (Q3). B_ij is 1 where the order is kept (Q4); sgn 0 gives
    0.5.

    Args:
        current: (N, 2) longitude, latitude, current frame, radians.
        target: (N, 2) the same, target frame; its yaw cancels out.
    """
    i, j = np.triu_indices(len(current), 1)
    u = np.stack([np.cos(current[:, 0]), np.sin(current[:, 0])], axis=1)
    delta_c = wrap_rad(current[i, 0] - current[j, 0])
    delta_t = wrap_rad(target[i, 0] - target[j, 0])
    # Of unit vectors a dot product is the cosine of the difference (2.4), a cross product its sine (2.5).
    spread, kept = np.cos(delta_c) - np.cos(delta_t), np.sin(delta_c) * np.sin(delta_t)
    directions = signed_bisectors(u[i], u[j], spread, kept)
    return PairVotes(directions, np.abs(delta_t) - np.abs(delta_c))


def signed_bisectors(u_i: FloatArray, u_j: FloatArray, spread: FloatArray, kept: FloatArray) -> FloatArray:
    """Bisectors (P, 2) of unit vectors with their signs, equations (2.3) to (2.6); zero if antipodal.

    Args:
        u_i: (P, 2) first of each pair, current frame.
        u_j: (P, 2) second.
        spread: (P,) dot product of the pair in the current frame less that in the target frame.
        kept: (P,) product of its cross products in both frames, positive where the order is kept.
    """
    bisector = u_i + u_j
    length = np.hypot(bisector[:, 0], bisector[:, 1])
    scale = np.where(length > 1e-9, 1.0 / np.maximum(length, 1e-9), 0.0)
    return np.asarray(vote_signs(spread, kept)[:, None] * bisector * scale[:, None])


def vote_signs(towards: FloatArray, kept: FloatArray) -> FloatArray:
    """Signs (N,) of votes, 1 + B (A - 1): A is the sign of `towards`, B whether `kept` is positive."""
    a, b = sign(towards), (sign(kept) + 1.0) / 2.0
    return 1.0 + b * (a - 1.0)


def sign(values: FloatArray) -> FloatArray:
    """Sign with a dead band for rounding errors."""
    return np.where(np.abs(values) <= TOLERANCE, 0.0, np.sign(values))
