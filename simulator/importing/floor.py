"""Where the floor of an imported world is: its height and its extent. Pure."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simulator.world.brought_floor import LEVEL_COS

FloatArray = npt.NDArray[np.float64]
Span = tuple[float, float]
BIN_M = 0.02  # heights this near are one level; chosen: uneven boards
SHARE = 0.5
"""The floor is the lowest level with this share of the largest one's area: roofs have as much."""
LEAST_M2 = 1.0  # less is no floor; chosen: where the robot can turn
MARGIN_M = 2.0  # of an endless floor round everything that stands on it; chosen: room to drive round it


@dataclass(frozen=True)
class Floor:
    """A level floor.

    Attributes:
        height_m: in the frame of the imported file.
        x_m, y_m: a rectangle round it.
        endless: whether it is a plane and not a mesh.
        fenced: whether one can get to its end; of an endless floor only.
    """

    height_m: float
    x_m: Span
    y_m: Span
    endless: bool
    fenced: bool = True


def find_floor(
    triangles: FloatArray, plane_m: float | None, at_m: tuple[float, float] | None
) -> Floor | None:
    """The floor among all triangles of a world.

    Args:
        triangles: corners, (n, 3, 3), z up.
        plane_m: height of an endless floor.
        at_m: a point where the robot is to stand: it is the lowest level there.

    Returns:
        None where nothing is level.
    """
    level, areas = _level(triangles)
    if at_m is not None:
        chosen = _covers(level, at_m)
        level, areas = level[chosen], areas[chosen]
    heights = level[..., 2].mean(axis=1)
    bins = np.round(heights / BIN_M).astype(int)
    found, back = np.unique(bins, return_inverse=True)
    total = np.bincount(back.reshape(-1), areas, minlength=len(found))
    if at_m is None:
        enough = total >= max(LEAST_M2, SHARE * float(total.max(initial=0.0)))
    else:
        enough = np.ones(len(found), bool)
    lowest = float(found[enough].min()) * BIN_M if enough.any() else None
    if plane_m is not None and (lowest is None or lowest > plane_m - BIN_M or at_m is not None):
        low, high = _bounds(triangles)
        own = lowest is not None and abs(lowest - plane_m) <= BIN_M
        return Floor(
            plane_m if not own else _exact(heights, areas, lowest or 0.0),
            (low[0] - MARGIN_M, high[0] + MARGIN_M),
            (low[1] - MARGIN_M, high[1] + MARGIN_M),
            endless=True,
        )
    if lowest is None:
        return None
    height_m = _exact(heights, areas, lowest)
    every, _ = _level(triangles)
    near = every[np.abs(every[..., 2] - height_m).max(axis=1) <= 2 * BIN_M]
    low, high = _bounds(near)
    return Floor(height_m, (low[0], high[0]), (low[1], high[1]), endless=False)


def _level(triangles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Triangles that lie level, front up, and their areas; either side up where there are none."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2
    areas = np.linalg.norm(normals, axis=1)
    up = normals[:, 2] > LEVEL_COS * areas
    if not (up & (areas > 0)).any():
        up = np.abs(normals[:, 2]) > LEVEL_COS * areas
    up &= areas > 0
    return triangles[up], areas[up]


def _covers(triangles: FloatArray, at_m: tuple[float, float]) -> npt.NDArray[np.bool_]:
    """Which triangles lie under or over a point."""
    a = triangles[..., :2] - np.array(at_m)
    b = np.roll(a, -1, axis=1)
    side = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return np.asarray((side >= 0).all(axis=1) | (side <= 0).all(axis=1))


def _exact(heights: FloatArray, areas: FloatArray, near_m: float) -> float:
    """Mean height of the level near a height, by area, metres to the tenth of a millimetre."""
    chosen = np.abs(heights - near_m) <= BIN_M
    return round(float(np.average(heights[chosen], weights=areas[chosen])), 4)


def _bounds(triangles: FloatArray) -> tuple[list[float], list[float]]:
    points = triangles.reshape(-1, 3)
    return points.min(axis=0).tolist(), points.max(axis=0).tolist()
