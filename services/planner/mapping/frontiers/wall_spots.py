"""Where walls are, by what beams of 30 degrees read along a way. Pure.

A beam tells how far the nearest thing in it is, not in which of its directions. Of the arc at that distance
most lies in floor that was seen free from other spots. Where so little of it is left that the robot does not
fit through, the thing is there, a metre or five away: a door in a wall leaves a gap between such spots.
"""

import math

import numpy as np
import numpy.typing as npt

from shared.mapgraph.frontiers import SECTOR_RAD
from shared.messages.base import SECTORS

FloatArray = npt.NDArray[np.float64]

ARC_POINTS = 13
"""Points on an arc; chosen: 2.5 degrees apart, 0.2 m at 5 m."""
MARGIN_M = 0.1
"""So far before an echo floor is free; chosen: several times the noise of a reading and of a short way."""
RAYS = 144
"""Directions of a view that may end at a wall; chosen: 2.5 degrees each."""
RAY_RAD = math.tau / RAYS


def wall_spots(views: FloatArray, radius_m: float, range_m: float) -> FloatArray:
    """(M, 2) spots where there is something, in the frame of the views.

    Args:
        views: (V, 3 + SECTORS) position, yaw and readings along one short way, in one frame.
        radius_m: of the robot.
        range_m: what a sensor reads that sees nothing.
    """
    echo_m = views[:, 3:]
    across_rad = np.linspace(-0.5, 0.5, ARC_POINTS) * SECTOR_RAD
    angle_rad = (views[:, 2, None] + np.arange(SECTORS) * SECTOR_RAD)[..., None] + across_rad
    ways = np.stack([np.cos(angle_rad), np.sin(angle_rad)], axis=-1)
    arcs = views[:, None, None, :2] + echo_m[..., None, None] * ways
    left = ~_is_free(arcs, views) & (echo_m < range_m)[..., None]
    first, last = left.argmax(axis=-1), ARC_POINTS - 1 - left[..., ::-1].argmax(axis=-1)
    ends = [np.take_along_axis(arcs, end[..., None, None], axis=2)[:, :, 0] for end in (first, last)]
    narrow = left.any(axis=-1) & (np.linalg.norm(ends[1] - ends[0], axis=-1) <= 2.0 * radius_m)
    return np.asarray((ends[0] + ends[1])[narrow] / 2.0)


def walls_along_rays(views: FloatArray, spots_m: FloatArray, radius_m: float) -> FloatArray:
    """(V, RAYS) how far from each view the nearest wall lies along each ray; infinite where none is known.

    Args:
        views: (V, 3 + SECTORS), of which the positions count.
        spots_m: (M, 2) of walls, in the same frame; rays are counted from its x axis.
        radius_m: of the robot, which passes no spot more closely.
    """
    walls_m = np.full((len(views), RAYS), np.inf)
    offset = spots_m[None] - views[:, None, :2]
    away_m = np.linalg.norm(offset, axis=-1)
    view, spot = np.nonzero(away_m > radius_m)
    offset, away_m = offset[view, spot], away_m[view, spot]
    middle = ray_of(offset)
    aside = np.arcsin(radius_m / away_m) / RAY_RAD
    for rays in range(math.ceil(aside.max(initial=0.0))):
        hit = rays <= aside
        for side in {-rays, rays}:
            np.minimum.at(walls_m, (view[hit], (middle[hit] + side) % RAYS), away_m[hit])
    return walls_m


def ray_of(offset_m: FloatArray) -> npt.NDArray[np.intp]:
    """(...) the ray that an offset (..., 2) from a view lies on."""
    bearing_rad = np.arctan2(offset_m[..., 1], offset_m[..., 0])
    return np.asarray(np.rint(bearing_rad / RAY_RAD), np.intp) % RAYS


def sector_towards(offset_m: FloatArray, yaw_rad: FloatArray | float) -> npt.NDArray[np.intp]:
    """(...) the sector of a robot turned by `yaw_rad` in which offsets (..., 2) from it lie."""
    bearing_rad = np.arctan2(offset_m[..., 1], offset_m[..., 0]) - yaw_rad
    return np.asarray(np.rint(bearing_rad / SECTOR_RAD), np.intp) % SECTORS


def _is_free(points_m: FloatArray, views: FloatArray) -> npt.NDArray[np.bool_]:
    """(...) whether any view saw floor at points (..., 2) and further."""
    offset = points_m[..., None, :] - views[:, :2]
    echo_m = views[np.arange(len(views)), 3 + sector_towards(offset, views[:, 2])]
    return np.asarray((np.linalg.norm(offset, axis=-1) < echo_m - MARGIN_M).any(axis=-1))
