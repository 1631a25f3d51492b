"""Fixed points seen from a moving upright camera, for synthetic scenes and path tracking (thesis 3.2.2).

No dynamics: the camera steps along its heading by speed times time, and the points are projected anew.
"""

import numpy as np
import numpy.typing as npt

from shared.geometry.angles import FloatArray
from shared.geometry.perspective import rotation_z
from shared.geometry.sphere import lonlat_from_bearings, with_last_axis


def lonlat_from_points(
    points_m: npt.ArrayLike, position_m: npt.ArrayLike, yaw_rad: float = 0.0
) -> FloatArray:
    """Longitude, latitude (N, 2), radians, of world points seen by a camera.

    Args:
        points_m: (N, 3) points, world frame, metres.
        position_m: (3,) camera position, world frame, metres.
        yaw_rad: turn of the camera frame about the vertical, world frame, radians.

    Raises:
        ValueError: a point in the camera's own position has no direction.
    """
    rays = with_last_axis("points_m", points_m, 3) - with_last_axis("position_m", position_m, 3)
    if not np.all(np.linalg.norm(rays, axis=-1) > 0.0):
        raise ValueError(
            "points_m must differ from position_m, got a point in the camera itself: leave it out"
        )
    return lonlat_from_bearings(rays @ rotation_z(yaw_rad))


def step_position(
    position_m: npt.ArrayLike, heading_rad: float, yaw_rad: float, speed_mps: float, time_s: float
) -> FloatArray:
    """Position (3,), metres, after moving along a heading of the camera frame at constant height."""
    course = heading_rad + yaw_rad
    step = speed_mps * time_s * np.array([np.cos(course), np.sin(course), 0.0])
    return np.asarray(with_last_axis("position_m", position_m, 3) + step, dtype=np.float64)
