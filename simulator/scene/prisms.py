"""A mesh -> upright convex prisms that stop the robot where the mesh would. Pure.

The mesh is cut into slices; what hangs together within a slice becomes one convex outline. So a table's legs
are apart from one another and its top is above them, and the free floor between the legs stays free.
"""

from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
SLICE_M = 0.1  # chosen: thinner than a seat is high
SLICED_M = 2.0  # above this nothing reaches the robot: one slice holds the rest
SKIN_M = 0.004  # sheets get a thickness, as solids need a volume
DIRECTIONS = 16  # corners of an outline at most: 1 / cos(pi / 16) is 2 % wider
MOST_GROUPS, GRAIN_M = 24, 0.3  # more groups in a slice, as leaves are, are put together by cells; chosen
MOST_PRISMS = 160  # chosen: a table has five, a plant twenty
SAME_AREA = 1.04  # outlines that together are this little larger are one; chosen


@dataclass(frozen=True)
class Prism:
    """Heights and outline, (corners, 2) counter-clockwise; metres."""

    low_m: float
    high_m: float
    outline_m: FloatArray


def prisms_of(vertices: FloatArray, triangles: npt.NDArray[np.integer]) -> list[Prism]:
    """Cut a mesh whose z axis points up.

    Raises:
        ValueError: it falls into too many pieces.
    """
    _, place = np.unique(np.round(vertices, 5), axis=0, return_inverse=True)
    places = place.reshape(-1)[triangles]
    done: list[Prism] = []
    open_: list[Prism] = []
    for z0, z1 in slices_of(vertices):
        fresh = _slice(vertices, triangles, places, z0, z1)
        closed, open_ = continued(open_, fresh)
        done += closed
    done += open_
    if len(done) > MOST_PRISMS:
        raise ValueError(
            f"the mesh must fall into at most {MOST_PRISMS} convex pieces, got {len(done)}; "
            "choose collision: box, or solid: false"
        )
    return done


def slices_of(vertices: FloatArray) -> list[tuple[float, float]]:
    """Heights between which a mesh is cut: SLICE_M apart up to SLICED_M, one slice above."""
    low, high = float(vertices[:, 2].min()), float(vertices[:, 2].max())
    cuts = np.arange(low, min(high, SLICED_M), SLICE_M)
    cuts = np.append(cuts[: max(1, len(cuts))], max(high, low + SKIN_M))
    return [(float(z0), float(z1)) for z0, z1 in pairwise(cuts)]


def within(
    vertices: FloatArray, triangles: npt.NDArray[np.integer], z0: float, z1: float
) -> npt.NDArray[np.bool_]:
    """Which triangles reach into a slice, (n,)."""
    z = vertices[triangles, 2]
    chosen = (z.max(axis=1) >= z0) & (z.min(axis=1) < z1)
    if z1 - z0 > SKIN_M and chosen.any():  # a top that only touches the lower cut belongs below
        chosen &= (z.max(axis=1) > z0 + 1e-6) | (z.min(axis=1) >= z0)
    return np.asarray(chosen)


def hull_outline(points: FloatArray) -> FloatArray:
    """Convex outline of (n, 2) points with a skin, of at most DIRECTIONS corners, counter-clockwise."""
    skin = SKIN_M / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    return convex((points[:, None] + skin).reshape(-1, 2))


def convex(points: FloatArray) -> FloatArray:
    """Convex outline of (n, 2) points, of at most DIRECTIONS corners, counter-clockwise."""
    hull = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2).astype(float)
    if len(hull) > DIRECTIONS:
        hull = _circumscribed(hull)
    return np.asarray(hull if twice_area(hull) > 0 else hull[::-1])


def _circumscribed(hull: FloatArray) -> FloatArray:
    """Polygon of DIRECTIONS sides around a hull: at most 2 % wider."""
    angles = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    reach = (hull @ normals.T).max(axis=0)
    following, distance = np.roll(normals, -1, axis=0), np.roll(reach, -1)
    cross = normals[:, 0] * following[:, 1] - normals[:, 1] * following[:, 0]
    x = (reach * following[:, 1] - distance * normals[:, 1]) / cross
    y = (distance * normals[:, 0] - reach * following[:, 0]) / cross
    return np.stack([x, y], axis=-1)


def _slice(
    vertices: FloatArray,
    triangles: npt.NDArray[np.integer],
    places: npt.NDArray[np.integer],
    z0: float,
    z1: float,
) -> list[Prism]:
    chosen = within(vertices, triangles, z0, z1)
    if not chosen.any():
        return []
    triangles, places = triangles[chosen], places[chosen]
    z = vertices[triangles, 2]
    group = _connected(places, z, z0, z1)
    points, owner = clipped(vertices, triangles, z0, z1)
    group = _coarsened(group[owner], points)
    found = []
    for k in np.unique(group):
        mine = points[group == k]
        low, high = float(mine[:, 2].min()), float(mine[:, 2].max())
        found.append(Prism(low, max(high, low + SKIN_M), hull_outline(mine[:, :2])))
    return found


def clipped(
    vertices: FloatArray, triangles: npt.NDArray[np.integer], z0: float, z1: float
) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Corners of the triangles within z0..z1, and where their edges pass z0 and z1; with their triangles."""
    number = np.repeat(np.arange(len(triangles)), 3)
    corners = vertices[triangles].reshape(-1, 3)
    ends = vertices[np.roll(triangles, -1, axis=1)].reshape(-1, 3)
    within = (corners[:, 2] >= z0) & (corners[:, 2] <= z1)
    points, owner = [corners[within]], [number[within]]
    for cut in (z0, z1):
        rise = ends[:, 2] - corners[:, 2]
        passes = (corners[:, 2] - cut) * (ends[:, 2] - cut) < 0
        t = (cut - corners[passes, 2]) / rise[passes]
        points.append(corners[passes] + t[:, None] * (ends[passes] - corners[passes]))
        owner.append(number[passes])
    return np.concatenate(points), np.concatenate(owner)


def _connected(places: npt.NDArray[np.integer], z: FloatArray, z0: float, z1: float) -> npt.NDArray[np.int64]:
    """Group of each triangle: joined by corners within the slice and by edges that pass through it."""
    number = np.arange(len(places))
    within = (z >= z0) & (z <= z1)
    following, z_following = np.roll(places, -1, axis=1), np.roll(z, -1, axis=1)
    through = (np.minimum(z, z_following) < z0) & (np.maximum(z, z_following) > z1)
    through |= ((z - z0) * (z_following - z0) < 0) | ((z - z1) * (z_following - z1) < 0)
    corner = np.stack([places, np.full_like(places, -1)], axis=-1)[within]
    edge = np.sort(np.stack([places, following], axis=-1), axis=-1)[through]
    owner = np.repeat(number[:, None], 3, axis=1)
    _, key = np.unique(np.concatenate([corner, edge]), axis=0, return_inverse=True)
    key, owners = key.reshape(-1), np.concatenate([owner[within], owner[through]])
    label = number.copy()
    while True:
        least = np.full(int(key.max(initial=-1)) + 1, len(places))
        np.minimum.at(least, key, label[owners])
        fresh = label.copy()
        np.minimum.at(fresh, owners, least[key])
        fresh = fresh[fresh]
        if (fresh == label).all():
            return label
        label = fresh


def _coarsened(group: npt.NDArray[np.int64], points: FloatArray) -> npt.NDArray[np.int64]:
    """Many small groups, as leaves are, are put together by cells of GRAIN_M."""
    if len(np.unique(group)) <= MOST_GROUPS:
        return group
    _, back = np.unique(group, return_inverse=True)
    back = back.reshape(-1)
    count = np.bincount(back)
    middle = np.stack([np.bincount(back, points[:, k]) / count for k in (0, 1)], axis=-1)
    _, cell = np.unique(np.floor(middle / GRAIN_M), axis=0, return_inverse=True)
    return np.asarray(cell.reshape(-1)[back], np.int64)


def continued(below: list[Prism], fresh: list[Prism]) -> tuple[list[Prism], list[Prism]]:
    """Join prisms of a slice to those below them that have nearly the same outline.

    Returns:
        What ends below this slice, and what may go on above it.
    """
    left, grown = list(below), []
    for prism in fresh:
        whole = prism
        for other in left:
            if abs(prism.low_m - other.high_m) > SKIN_M:
                continue
            both = convex(np.concatenate([prism.outline_m, other.outline_m]))
            least = min(twice_area(prism.outline_m), twice_area(other.outline_m))
            if twice_area(both) < SAME_AREA * least + SKIN_M**2:
                whole = Prism(other.low_m, prism.high_m, both)
                left = [one for one in left if one is not other]
                break
        grown.append(whole)
    return left, grown


def twice_area(outline: FloatArray) -> float:
    """Twice the area that an outline encloses, positive if it runs counter-clockwise."""
    x, y = outline.T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
