"""What pairs of matches and single matches say about the heading, equations (2.1) to (2.17) of the thesis."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import FloatArray, wrap_rad

TOLERANCE = 1e-12
"""Rounding of a dot product of unit vectors: below it two angles are equal, and identical frames do not
vote."""

ANTIPODAL = 1e-9
"""Length of the sum of two unit vectors below which they are opposite and have no bisector (Q4)."""


@dataclass(frozen=True, eq=False)
class Votes:
    """One row per vote.

    Attributes:
        directions: (M, 2) signed directions u_ij of equation (2.6) or u_i of (2.15), current frame.
        growth_rad: (M,) change of what the weight of methods 2 and 4 is a function of, (2.9) or (2.17),
            radians.
    """

    directions: FloatArray
    growth_rad: FloatArray


def pair_votes(current: FloatArray, target: FloatArray) -> Votes:
    """Votes of all unordered pairs i < j (Q6), in the order of numpy.triu_indices: signed bisectors (2.6).

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
    return Votes(directions, np.abs(delta_t) - np.abs(delta_c))


def latitude_votes(current: FloatArray, target: FloatArray) -> Votes:
    """Votes of single matches (2.15): towards a feature whose latitude grows in magnitude, else away from it.

    A latitude that changes its sign counts as "in front" by (2.14), though a camera at fixed height cannot
    see that (Q5): such a match is an outlier.

    Args:
        current: (N, 2) longitude, latitude, current frame, radians.
        target: (N, 2) the same, target frame; its longitudes are not used.
    """
    lat_c, lat_t = current[:, 1], target[:, 1]
    u = np.stack([np.cos(current[:, 0]), np.sin(current[:, 0])], axis=1)
    # (2.13) and (2.14): both cross products with the x axis are -sin.
    signs = vote_signs(np.cos(lat_c) - np.cos(lat_t), np.sin(lat_c) * np.sin(lat_t))
    return Votes(signs[:, None] * u, np.abs(lat_t) - np.abs(lat_c))


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
    scale = np.where(length > ANTIPODAL, 1.0 / np.maximum(length, ANTIPODAL), 0.0)
    return np.asarray(vote_signs(spread, kept)[:, None] * bisector * scale[:, None])


def vote_signs(towards: FloatArray, kept: FloatArray) -> FloatArray:
    """Signs (N,) of votes, 1 + B (A - 1): A is the sign of `towards`, B whether `kept` is positive."""
    a, b = _sign(towards), (_sign(kept) + 1.0) / 2.0
    return 1.0 + b * (a - 1.0)


def _sign(values: FloatArray) -> FloatArray:
    """Sign with a dead band for rounding errors."""
    return np.where(np.abs(values) <= TOLERANCE, 0.0, np.sign(values))
