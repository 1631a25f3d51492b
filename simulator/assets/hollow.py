"""Whether a mesh is hollow: its hulls would fill floor on which the robot fits between its faces. Pure."""

import cv2
import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import Mesh
from simulator.scene.prisms import clipped, prisms_of

FloatArray = npt.NDArray[np.float64]
Grid = npt.NDArray[np.uint8]
REACH_M = 0.8  # of the robot above the floor: its mast
CELL_M = 0.04  # chosen: a sixth of the robot's radius
MOST_CELLS = 4000  # along a side: larger meshes get larger cells
ROBOT_M = 0.26
LOST_M2 = 0.25
"""Less floor lost is of no use to the robot; chosen: where it can just turn."""
FULL = 0.8
"""A mesh that encloses this share of the prism over its outline is a solid, not a room. Chosen."""


def is_hollow(shape: Mesh, low_m: float) -> bool:
    """Whether one node of a model needs sheets along its faces in place of hulls.

    Args:
        shape: the node, z up, metres.
        low_m: height of the floor that the model stands on.
    """
    points = shape.vertices.astype(float)
    low, high = points.min(axis=0), points.max(axis=0)
    if (high - low)[:2].min() < 2 * ROBOT_M or low[2] > low_m + REACH_M or _is_full(points, shape.triangles):
        return False
    origin = low[:2] - 2 * ROBOT_M
    span = high[:2] + 2 * ROBOT_M - origin
    cell = max(CELL_M, float(span.max()) / MOST_CELLS)
    columns, rows = (np.ceil(span / cell).astype(int) + 1).tolist()
    faces, hulls = np.zeros((rows, columns), np.uint8), np.zeros((rows, columns), np.uint8)
    for outline in _faces(points, shape.triangles, low_m + 0.02, low_m + REACH_M):
        _fill(faces, outline, origin, cell)
    if not _room(faces, cell).any():
        return False
    for outline in _hulls(points, shape.triangles, low_m + 0.02, low_m + REACH_M):
        _fill(hulls, outline, origin, cell)
    return bool((_room(faces, cell) & ~_room(hulls, cell)).sum() * cell**2 >= LOST_M2)


def _is_full(points: FloatArray, triangles: npt.NDArray[np.integer]) -> bool:
    """By the volume that the faces enclose, and that of the upright prism over their hull."""
    a, b, c = (points[triangles[:, k]] - points[0] for k in range(3))
    volume = abs(float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum())) / 6.0
    area = float(cv2.contourArea(cv2.convexHull(points[:, :2].astype(np.float32))))
    return volume >= FULL * area * float(np.ptp(points[:, 2])) > 0.0


def _faces(
    points: FloatArray, triangles: npt.NDArray[np.integer], low_m: float, high_m: float
) -> list[FloatArray]:
    """Each triangle's part between two heights, seen from above, (corners, 2)."""
    z = points[triangles, 2]
    chosen = triangles[(z.max(axis=1) >= low_m) & (z.min(axis=1) <= high_m)]
    corners, owner = clipped(points, chosen, low_m, high_m)
    order = np.argsort(owner, kind="stable")
    cuts = np.flatnonzero(np.diff(owner[order])) + 1
    return np.split(corners[order, :2], cuts) if len(corners) else []


def _hulls(
    points: FloatArray, triangles: npt.NDArray[np.integer], low_m: float, high_m: float
) -> list[FloatArray]:
    try:
        found = prisms_of(points, triangles)
    except ValueError:  # too many pieces: hulls are no choice
        return [points[:, :2]]
    return [prism.outline_m for prism in found if prism.low_m < high_m and prism.high_m > low_m]


def _fill(grid: Grid, outline: FloatArray, origin: FloatArray, cell: float) -> None:
    corners = cv2.convexHull(np.round((outline - origin) / cell).astype(np.int32))
    cv2.fillConvexPoly(grid, corners, 1)


def _room(filled: Grid, cell: float) -> npt.NDArray[np.bool_]:
    """Where a robot's centre has room."""
    return np.asarray(cv2.distanceTransform(1 - filled, cv2.DIST_L2, 5) * cell >= ROBOT_M)
