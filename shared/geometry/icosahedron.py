"""Tangent images on a subdivided icosahedron (Eder et al. 2020; thesis 2.2.1.2).

Subdivision s gives 20 * 4^s faces and pictures of 2^(b - s) pixels for base level b: 80 of 256 x 256 for (9,
1). Two vertices stand at the poles, so no face centre does, and every picture can have north upwards.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.geometry.perspective import PerspectiveView
from shared.geometry.sphere import FloatArray, bearings_from_lonlat, lonlat_from_bearings, with_last_axis

MARGIN_RAD = float(np.deg2rad(2.0))
"""Picture beyond the face; chosen: ten pixels, so that descriptors at its border see their surroundings."""


@dataclass(frozen=True, eq=False)
class TangentLayout:
    """Faces of the sphere and the picture of each.

    Attributes:
        triangles: (F, 3, 3) unit corner bearings per face, counter-clockwise seen from outside.
        edge_normals: (F, 3, 3) unit normals of the edge planes, pointing into the face.
        views: F pictures, centred on the faces, north upwards.
    """

    triangles: FloatArray
    edge_normals: FloatArray
    views: tuple[PerspectiveView, ...]

    @property
    def centres(self) -> FloatArray:
        """Face centres, (F, 3) unit bearings."""
        return _unit(self.triangles.mean(axis=1))

    def faces_of(self, bearings: npt.ArrayLike) -> npt.NDArray[np.intp]:
        """Face index (...,) of each bearing (..., 3): exactly one, the first where an edge is shared."""
        b = with_last_axis("bearings", bearings, 3)
        depth = np.einsum("fek,...k->...fe", self.edge_normals, b).min(axis=-1)
        return np.asarray(np.argmax(depth, axis=-1), dtype=np.intp)

    def owned(self, face: int, pixels: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether pixels (N, 2) of a face's picture lie in the face itself, so that none is kept twice."""
        return np.asarray(
            self.faces_of(self.views[face].bearings_from_pixels(pixels)) == face, dtype=np.bool_
        )


def tangent_layout(base_level: int = 9, subdivision: int = 1) -> TangentLayout:
    """Layout with 20 * 4^subdivision faces and pictures of 2^(base_level - subdivision) pixels."""
    if subdivision < 0 or base_level < subdivision:
        raise ValueError(f"need 0 <= subdivision <= base_level, got {subdivision} and {base_level}")
    triangles = _icosahedron()
    for _ in range(subdivision):
        triangles = _subdivide(triangles)
    edges = np.cross(triangles, np.roll(triangles, -1, axis=1))
    size = 2 ** (base_level - subdivision)
    centres = lonlat_from_bearings(triangles.mean(axis=1))
    fov = _common_fov(triangles, centres)
    views = tuple(PerspectiveView(size, size, fov, float(lon), float(lat)) for lon, lat in centres)
    return TangentLayout(triangles, _unit(edges), views)


def _icosahedron() -> FloatArray:
    """Corners (20, 3, 3) of a regular icosahedron with vertices at both poles."""
    ring_lat, step = np.arctan(0.5), 2.0 * np.pi / 5.0
    north, south = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
    upper = bearings_from_lonlat([(k * step, ring_lat) for k in range(5)])
    lower = bearings_from_lonlat([((k + 0.5) * step, -ring_lat) for k in range(5)])
    faces = []
    for k in range(5):
        n = (k + 1) % 5
        faces += [(north, upper[k], upper[n]), (upper[k], lower[k], upper[n])]
        faces += [(lower[k], lower[n], upper[n]), (south, lower[n], lower[k])]
    return np.array(faces)


def _subdivide(triangles: FloatArray) -> FloatArray:
    """Four faces (4F, 3, 3) for each one, by the midpoints of its edges."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, bc, ca = _unit(a + b), _unit(b + c), _unit(c + a)
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3, 3)


def _common_fov(triangles: FloatArray, centres: FloatArray) -> float:
    """Smallest opening (rad) of a square picture that holds any of the faces, and the margin."""
    reach = 0.0
    for corners, (lon, lat) in zip(triangles, centres, strict=True):
        local = corners @ PerspectiveView(1, 1, 1.0, float(lon), float(lat)).rotation
        reach = max(reach, float(np.max(np.abs(local[:, 1:] / local[:, :1]))))
    return 2.0 * (float(np.arctan(reach)) + MARGIN_RAD)


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True), dtype=np.float64)
