"""A concave mesh -> thin upright prisms along its outlines, as walls with rooms between them need. Pure.

The hull of a house fills it. Here the mesh is cut into slices, each slice is drawn on a grid of CELL_M, and
what is drawn gets a sheet along each piece of its outlines, one cell thick. What the mesh encloses stays
hollow; cavities without room for anything are closed.
"""

from dataclasses import dataclass, field
from itertools import pairwise

import cv2
import numpy as np
import numpy.typing as npt

from simulator.scene.prisms import SKIN_M, Prism, clipped

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.integer]
Grid = npt.NDArray[np.uint8]
CELL_M = 0.04  # chosen: a sixth of the robot's radius; what is felt is so much thicker than what is seen
MOST_CELLS = 4000  # along a side: larger meshes get larger cells
STRAIGHT_CELLS = 0.5  # how far a sheet may be from the outline
CAVITY_M2 = 0.15  # smaller ones are closed: no robot gets in; chosen
LEVEL_SLICE_M = 0.02  # of what lies level: what is in one slice with the floor is driven over
EDGE_M = 0.02  # what is no higher lies level, too
LEVEL_COS = 0.95  # what lies level is a layer of its own: a floor does not fill the slice it lies in
SLICE_M = 0.25  # chosen: the robot's body is as high, and above it there is only its mast
SLICED_M = 1.0  # above the mesh's lowest point one slice holds the rest: nothing there reaches the robot


@dataclass
class _Layer:
    """Cells between two heights."""

    low_m: float
    high_m: float
    cells: Grid = field(repr=False)


def shell_of(vertices: FloatArray, triangles: IntArray) -> list[Prism]:
    """Cut a mesh whose z axis points up."""
    flat = vertices[:, :2]
    origin = flat.min(axis=0) - 2 * CELL_M
    span = flat.max(axis=0) + 2 * CELL_M - origin
    cell = max(CELL_M, float(span.max()) / MOST_CELLS)
    columns, rows = (np.ceil(span / cell).astype(int) + 1).tolist()
    level = _is_level(vertices, triangles)
    layers: list[_Layer] = []
    for kind, slice_m in ((triangles[~level], SLICE_M), (triangles[level], LEVEL_SLICE_M)):
        slices = _slices(vertices, slice_m)
        drawn = [_layer(vertices, kind, z, origin, cell, (rows, columns)) for z in slices]
        layers += _merged([layer for layer in drawn if layer is not None])
    return [prism for layer in layers for prism in _sheets(layer, origin, cell)]


def _is_level(vertices: FloatArray, triangles: IntArray) -> npt.NDArray[np.bool_]:
    """Which triangles lie level, or are as low as the edge of a carpet, (n,)."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    size = np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    low = np.ptp(vertices[triangles, 2], axis=1) < EDGE_M
    return np.asarray((np.abs(normals[:, 2]) > LEVEL_COS * size) | low)


def _slices(vertices: FloatArray, slice_m: float) -> list[tuple[float, float]]:
    low, high = float(vertices[:, 2].min()), float(vertices[:, 2].max())
    cuts = low + np.arange(0.0, SLICED_M + slice_m / 2, slice_m)
    cuts = np.append(cuts[(cuts < high - SKIN_M) | (cuts == low)], max(high, low + SKIN_M))
    return [(float(z0), float(z1)) for z0, z1 in pairwise(cuts)]


def _layer(
    vertices: FloatArray,
    triangles: IntArray,
    slice_m: tuple[float, float],
    origin: FloatArray,
    cell: float,
    shape: tuple[int, int],
) -> _Layer | None:
    """The cells that triangles touch between two heights; None if they touch none."""
    z = vertices[triangles, 2]
    chosen = triangles[(z.max(axis=1) >= slice_m[0]) & (z.min(axis=1) < slice_m[1])]
    points, owner = clipped(vertices, chosen, *slice_m)
    if not len(points):
        return None
    order = np.argsort(owner, kind="stable")
    places = np.round((points[order, :2] - origin) / cell).astype(np.int32)
    cells = np.zeros(shape, np.uint8)
    for outline in np.split(places, np.flatnonzero(np.diff(owner[order])) + 1):
        cv2.fillConvexPoly(cells, cv2.convexHull(outline), 1)
    return _Layer(float(points[:, 2].min()), float(points[:, 2].max()), cells)


def _merged(layers: list[_Layer]) -> list[_Layer]:
    """Layers that touch and have the same cells are one: walls have them all the way up."""
    found: list[_Layer] = []
    for layer in layers:
        last = found[-1] if found else None
        if last is not None and layer.low_m - last.high_m <= SKIN_M and (last.cells == layer.cells).all():
            last.high_m = layer.high_m
        else:
            found.append(layer)
    return found


def _sheets(layer: _Layer, origin: FloatArray, cell: float) -> list[Prism]:
    closed = _without_cavities(layer.cells, cell)
    return outline_sheets(closed, origin, cell, layer.low_m, max(layer.high_m, layer.low_m + SKIN_M))


def outline_sheets(
    cells: Grid, origin_m: FloatArray, cell_m: float, low_m: float, high_m: float
) -> list[Prism]:
    """A sheet along each straight piece of the outlines of what is filled on a grid.

    Args:
        cells: (rows, columns), above 0 where it is filled.
        origin_m: x and y of the middle of cell (0, 0).
        cell_m: side of a cell; sheets are as thick.
        low_m: where the sheets begin.
        high_m: where they end.
    """
    contours, _ = cv2.findContours(cells, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)
    found = []
    for contour in contours:
        corners = cv2.approxPolyDP(contour, STRAIGHT_CELLS, True).reshape(-1, 2)
        ends = np.roll(corners, -1, axis=0) if len(corners) > 2 else corners[::-1][:1]
        for a, b in zip(corners, ends, strict=False):
            outline = _rectangle(a * cell_m + origin_m, b * cell_m + origin_m, cell_m)
            found.append(Prism(low_m, high_m, outline))
    return found


def _without_cavities(cells: Grid, cell: float) -> Grid:
    empty = (1 - cells).astype(np.uint8)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(empty, connectivity=4)
    small = [k for k in range(1, count) if stats[k, cv2.CC_STAT_AREA] * cell**2 < CAVITY_M2]
    return np.asarray(cells | np.isin(labels, small), np.uint8)


def _rectangle(a: FloatArray, b: FloatArray, cell: float) -> FloatArray:
    """Corners round the line from a to b, half a cell longer and wider on all sides."""
    along = b - a
    length = float(np.hypot(*along))
    u = along / length if length > 0.0 else np.array([1.0, 0.0])
    v = np.array([-u[1], u[0]])
    half, start, end = cell / 2, a - u * cell / 2, b + u * cell / 2
    return np.array([start - v * half, end - v * half, end + v * half, start + v * half])
