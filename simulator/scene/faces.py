"""Flat faces with any corners, such as roofs and gables, as parts. Pure."""

import hashlib

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import Mesh, refined
from simulator.scene.parts import Geometry, Material, Part, Vec3
from simulator.scene.texturing import GRAIN_M

MOST_TRIANGLES = 20_000  # chosen: far above a roof's


def face(corners_m: list[Vec3], facing: Vec3, material: Material, tile_m: float) -> Part:
    """A convex face of three or more corners, seen from the side it faces; it stops nobody.

    Args:
        corners_m: in order round the face.
        facing: roughly towards the side that is seen.
        material: its look.
        tile_m: side of one texture repeat; the texture's rows run level.
    """
    points = np.array(corners_m, float)
    normal = np.cross(points[1] - points[0], points[2] - points[0])
    normal *= np.sign(normal @ np.array(facing)) / np.linalg.norm(normal)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    mesh = refined(_fan(points - middle, normal, tile_m), GRAIN_M * 2, MOST_TRIANGLES)
    digest = hashlib.sha256(mesh.vertices.tobytes() + mesh.uvs.tobytes()).hexdigest()
    size = np.maximum(np.ptp(points, axis=0), 0.02)
    return Part("mesh", _vec(middle), _vec(size), material, solid=False, geometry=Geometry(digest, mesh))


def _fan(points: npt.NDArray[np.float64], normal: npt.NDArray[np.float64], tile_m: float) -> Mesh:
    level = np.cross((0.0, 0.0, 1.0), normal)
    along = level / np.linalg.norm(level) if np.linalg.norm(level) > 1e-6 else np.array((1.0, 0.0, 0.0))
    up = np.cross(normal, along)
    uvs = np.stack([points @ along, -(points @ up)], axis=-1) / tile_m
    order = np.array([(0, k, k + 1) for k in range(1, len(points) - 1)], np.uint32)
    side = np.cross(points[order[0, 1]] - points[order[0, 0]], points[order[0, 2]] - points[order[0, 0]])
    triangles = order if side @ normal > 0.0 else order[:, ::-1]
    return Mesh(
        points.astype(np.float32),
        np.tile(normal, (len(points), 1)).astype(np.float32),
        uvs.astype(np.float32),
        triangles,
    )


def _vec(values: npt.NDArray[np.float64]) -> Vec3:
    x, y, z = (float(v) for v in values)
    return x, y, z
