"""Floor that furniture brings with it: where level triangles lie at height 0. Pure.

Grounds without a floor of their own are floor only there; beyond it the robot would fall.
"""

import cv2
import numpy as np
import numpy.typing as npt

from simulator.assets.shell import outline_sheets
from simulator.scene.parts import Part, rotation_of
from simulator.scene.shapes import hull_part
from simulator.world.world_file import WorldFile

FloatArray = npt.NDArray[np.float64]
Grid = npt.NDArray[np.bool_]
LOW_M, HIGH_M = -0.05, 0.03
"""Heights that count as floor; chosen: what a wheel rolls over, and boards laid a little deep."""
LEVEL_COS = 0.95
"""Upward component of the normal of what one drives on: 18 degrees."""
GAP_M = 0.4
"""Narrower gaps are driven over: a sill without floor below the door. Chosen: less than the robot's width."""
CELL_M = 0.05  # of the grid on which edges are found, as of freespace for small worlds
EDGE_M = (0.0, 0.3)  # an edge is as high as the robot's body
SHIFT = 4  # bits behind the point in OpenCV's coordinates


def floor_grid(world: WorldFile, parts: tuple[Part, ...], xs_m: FloatArray, ys_m: FloatArray) -> Grid:
    """Where the world has floor at the points of a grid, (len(ys), len(xs))."""
    inside = np.zeros((len(ys_m), len(xs_m)), bool)
    bare = inside.copy()
    for ground in world.grounds:
        if ground.floor is None:
            bare |= _within(xs_m, ys_m, (ground.x_m, ground.y_m))
    areas = [*world.rooms, *world.openings, *(g for g in world.grounds if g.floor is not None)]
    for area in areas:
        inside |= _within(xs_m, ys_m, (area.x_m, area.y_m))
    if bare.any():
        inside |= bare & brought(parts, xs_m, ys_m)
    return inside


def edges(world: WorldFile, parts: tuple[Part, ...]) -> list[Part]:
    """What stops the robot where the floor ends that furniture brings; it is not seen, as a drop is not."""
    found: list[Part] = []
    for ground in world.grounds:
        if ground.floor is not None or not parts:
            continue
        (x0, x1), (y0, y1) = ground.x_m, ground.y_m
        xs = np.arange(x0 - 2 * CELL_M, x1 + 2.5 * CELL_M, CELL_M)
        ys = np.arange(y0 - 2 * CELL_M, y1 + 2.5 * CELL_M, CELL_M)
        floor = brought(parts, xs, ys) & _within(xs, ys, (ground.x_m, ground.y_m))
        origin = np.array([xs[0], ys[0]])
        sheets = outline_sheets(floor.astype(np.uint8), origin, CELL_M, *EDGE_M)
        found += [hull_part(sheet, parts[0].material) for sheet in sheets]
    return found


def brought(parts: tuple[Part, ...], xs_m: FloatArray, ys_m: FloatArray) -> Grid:
    """Where meshes lie level at height 0, narrow gaps closed."""
    step_m = float(xs_m[1] - xs_m[0]) if len(xs_m) > 1 else 1.0
    grid = np.zeros((len(ys_m), len(xs_m)), np.uint8)
    origin = np.array([xs_m[0], ys_m[0]])
    for part in parts:
        triangles = level_triangles(part)
        points = np.round((triangles[..., :2] - origin) / step_m * 2**SHIFT).astype(np.int32)
        for triangle in points:
            cv2.fillConvexPoly(grid, triangle, 1, cv2.LINE_8, SHIFT)
    cells = max(1, round(GAP_M / 2 / step_m))
    around = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * cells + 1, 2 * cells + 1))
    padded = cv2.copyMakeBorder(grid, cells, cells, cells, cells, cv2.BORDER_CONSTANT, value=0)
    closed = cv2.morphologyEx(padded, cv2.MORPH_CLOSE, around)
    return np.asarray(closed[cells:-cells, cells:-cells] > 0)


def level_triangles(part: Part) -> FloatArray:
    """Corners of the triangles of a part that one can drive on, (n, 3, 3) world frame."""
    z_m, half_m = part.centre_m[2], part.size_m[2] / 2
    if part.geometry is None or z_m - half_m > HIGH_M or z_m + half_m < LOW_M:
        return np.zeros((0, 3, 3))
    mesh = part.geometry.mesh
    points = mesh.vertices.astype(float) @ rotation_of(part).T + np.array(part.centre_m)
    corners = points[mesh.triangles]
    corners = corners[(corners[..., 2] >= LOW_M).all(axis=1) & (corners[..., 2] <= HIGH_M).all(axis=1)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    return np.asarray(corners[(normals[:, 2] > LEVEL_COS * length) & (length > 0.0)])


def _within(
    xs_m: FloatArray, ys_m: FloatArray, rect: tuple[tuple[float, float], tuple[float, float]]
) -> Grid:
    (x0, x1), (y0, y1) = rect
    return ((xs_m >= x0) & (xs_m <= x1))[None, :] & ((ys_m >= y0) & (ys_m <= y1))[:, None]
