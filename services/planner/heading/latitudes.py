"""Votes of single matches by their latitudes for methods 3 and 4, equations (2.11) to (2.15)."""

from dataclasses import dataclass

import numpy as np

from services.planner.heading.pairs import vote_signs
from shared.geometry.angles import FloatArray


@dataclass(frozen=True, eq=False)
class LatitudeVotes:
    """One row per match.

    Attributes:
        directions: (N, 2) signed longitude vectors u_i of equation (2.15).
        growth_rad: (N,) change of the latitude's magnitude, equation (2.17), radians.
    """

    directions: FloatArray
    growth_rad: FloatArray


def latitude_votes(current: FloatArray, target: FloatArray) -> LatitudeVotes:
    """Towards a feature whose latitude grows in magnitude, away from one whose latitude shrinks.

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
    return LatitudeVotes(signs[:, None] * u, np.abs(lat_t) - np.abs(lat_c))
