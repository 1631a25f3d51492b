"""Closed ways over free floor for walkers, with room to spare on both sides. Pure."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from simulator.world.freespace import FreeSpace, Point

FloatArray = npt.NDArray[np.float64]
# All chosen: ways that cross rooms and take a minute.
STEP_M = 0.05
SPARE_M = 0.06  # on both sides, half of it where straightened ways cut corners
STATIONS = 3
FAR_M = 12.0  # of a station from the first one
SHORTEST_M = 3.0
DRAWS = 40


def closed_route(space: FreeSpace, radius_m: float, rng: np.random.Generator) -> FloatArray | None:
    """A closed way through STATIONS random places, a point every STEP_M, (n, 2); None if there is no room.

    A disc of `radius_m` on any of the points touches nothing.
    """
    roomy = replace(space, free=space.free & (space.clearance_m >= radius_m + SPARE_M))
    if not roomy.free.any():
        return None
    for _ in range(DRAWS):
        stations = _stations(roomy, rng)
        legs = [roomy.shortest_path(a, b) for a, b in pairwise([*stations, stations[0]])]
        if not all(legs):
            continue
        route = _evenly([point for leg in legs for point in leg])
        if len(route) * STEP_M >= SHORTEST_M and _has_room(route, space, radius_m):
            return route
    return None


def _stations(space: FreeSpace, rng: np.random.Generator) -> list[Point]:
    first = space.random_pose(rng)[:2]
    others = [space.random_pose(rng)[:2] for _ in range(8 * STATIONS)]
    return [first, *[p for p in others if math.dist(first, p) <= FAR_M][: STATIONS - 1]]


def _evenly(corners: list[Point]) -> FloatArray:
    """Points every STEP_M along a polyline."""
    line = np.array(corners)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.arange(0.0, along[-1], STEP_M)
    return np.stack([np.interp(at, along, line[:, k]) for k in (0, 1)], axis=-1)


def _has_room(route: FloatArray, space: FreeSpace, radius_m: float) -> bool:
    cells = [space.cell((float(x), float(y))) for x, y in route]
    return all(space.clearance_m[row, column] >= radius_m + SPARE_M / 2 for row, column in cells)
