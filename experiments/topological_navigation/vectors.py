"""Unit vectors of the thesis's heading methods as its library names them (equations 2.1 to 2.15)."""

import numpy as np

from services.planner.heading.votes import signed_bisectors, vote_signs
from shared.geometry.sphere import FloatArray


def keypoint_unit_vectors(keypoints_ang: FloatArray) -> FloatArray:
    """Longitude unit vectors (N, 2) of longitudes (N,) or longitudes and latitudes (N, 2), radians (Q29)."""
    angles = np.asarray(keypoints_ang, np.float64)
    longitude = angles[:, 0] if angles.ndim == 2 else angles
    return np.stack([np.cos(longitude), np.sin(longitude)], axis=1)


def pair_headings(u_c: list[FloatArray], u_t: list[FloatArray]) -> FloatArray:
    """Signed bisectors (P, 2) of pairs, equations (2.3) to (2.6); zero for antipodal pairs.

    Args:
        u_c: [u_ci, u_cj], each (P, 2), current frame.
        u_t: [u_ti, u_tj], each (P, 2), target frame.
    """
    (ci, cj), (ti, tj) = u_c, u_t
    spread = (ci * cj).sum(axis=1) - (ti * tj).sum(axis=1)
    return signed_bisectors(ci, cj, spread, _cross(ci, cj) * _cross(ti, tj))


def latitude_headings(u_c: FloatArray, v_c: FloatArray, v_t: FloatArray, v_h: FloatArray) -> FloatArray:
    """Longitude vectors (N, 2) signed by their latitudes, equations (2.11) to (2.15).

    Args:
        u_c: (N, 2) longitude unit vectors, current frame.
        v_c: (N, 2) latitude unit vectors, current frame.
        v_t: (N, 2) latitude unit vectors, target frame.
        v_h: (2,) horizontal unit vector.
    """
    signs = vote_signs(v_c @ v_h - v_t @ v_h, _cross(v_c, v_h) * _cross(v_t, v_h))
    return np.asarray(signs[:, None] * u_c)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    b = np.broadcast_to(b, a.shape)
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
