"""The picture plane of an ordinary camera, in halves of the photo's longer side. Pure.

The camera looks along x, y left, z up. A point of the plane is (left, up); with the focal length f in the
same unit it is seen in direction (f, left, up), and the field of view over the longer side is 2 atan(1 / f).
A small thing of size s on the plane, where n = |(f, left, up)|, covers the angle s sqrt(f / n^3): the root of
what an area does.
"""

import numpy as np

from shared.geometry.sphere import FloatArray, bearings_from_lonlat

NARROWEST_RAD, WIDEST_RAD = float(np.deg2rad(48.0)), float(np.deg2rad(112.0))
"""Fields of view that are looked for: phones have 50 to 110 degrees, but for tele lenses."""
USUAL_RAD = float(np.deg2rad(76.0))
"""Taken where nobody knows it: the middle of those in ln f."""

FOVS_RAD = tuple(np.deg2rad([52.0, 62.0, 75.0, 90.0, 106.0]).tolist())
"""Fields of view that are tried where it is unknown: steps of some 0.2 in ln f, which refinement bridges."""


def focal_of(fov_rad: float) -> float:
    """Focal length of a field of view over the longer side."""
    return 1.0 / float(np.tan(0.5 * fov_rad))


def fov_of(focal: float) -> float:
    """Field of view over the longer side, radians."""
    return 2.0 * float(np.arctan(1.0 / focal))


def rays(plane: FloatArray, focal: float) -> tuple[FloatArray, FloatArray]:
    """Unit bearings (N, 3) of points (N, 2) of the plane, and their distances (N,) from the camera."""
    ahead = np.concatenate([np.full((len(plane), 1), focal), plane], axis=1)
    far = np.linalg.norm(ahead, axis=1)
    return ahead / far[:, None], far


def plane_from_lonlat(lonlat_rad: FloatArray, focal: float) -> FloatArray:
    """Points (N, 2) of the plane of a camera that looks to 0, 0, from longitudes and latitudes (N, 2)."""
    bearing = bearings_from_lonlat(lonlat_rad)
    return np.asarray(focal * bearing[:, 1:] / bearing[:, :1], dtype=np.float64)


def area_sr(focal: float, short: float) -> float:
    """Solid angle of a photo whose shorter side is `short` of its longer one (of a pyramid, exactly)."""
    return 4.0 * float(np.arcsin(short / np.sqrt((1.0 + focal**2) * (short**2 + focal**2))))


def log_angle(focal: float, far: FloatArray) -> FloatArray:
    """Ln (N,) of the angle that something of size 1 on the plane covers, so far from the camera's centre."""
    return np.asarray(0.5 * np.log(focal) - 1.5 * np.log(far), dtype=np.float64)
