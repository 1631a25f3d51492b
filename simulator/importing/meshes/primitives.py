"""Boxes, cylinders and spheres as triangles. Pure.

Texture coordinates run from 0 to 1 over each face of a box and once round a cylinder or a sphere, as
in Gazebo.
"""

import numpy as np

from simulator.importing.entities import Primitive
from simulator.importing.meshes.surfaces import FloatArray, IntArray, Look, Surface
from simulator.scene.meshes import grid_triangles

ROUND = 24  # corners of a circle; chosen: a column of 1 m is round to 5 mm
FACES = (
    ((1, 0, 0), (0, 1, 0)),
    ((-1, 0, 0), (0, -1, 0)),
    ((0, 1, 0), (-1, 0, 0)),
    ((0, -1, 0), (1, 0, 0)),
    ((0, 0, 1), (1, 0, 0)),
    ((0, 0, -1), (-1, 0, 0)),
)
"""Normal of each face of a box, and the direction of its u; v is what is left: up on walls."""


def surface_of(primitive: Primitive, look: Look, node: str, tile_m: float | None = None) -> Surface:
    """A primitive around its origin; with `tile_m` a box repeats its picture after so many metres."""
    if primitive.kind == "box":
        x, y, z = primitive.size_m
        vertices, uvs, triangles = _box(x, y, z, tile_m)
    elif primitive.kind == "cylinder":
        vertices, uvs, triangles = _cylinder(*primitive.size_m)
    else:
        vertices, uvs, triangles = _sphere(*primitive.size_m)
    return Surface(node, vertices, triangles, look, uvs)


def _box(x: float, y: float, z: float, tile_m: float | None) -> tuple[FloatArray, FloatArray, IntArray]:
    half = np.array([x, y, z]) / 2
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    corners, uvs, triangles = [], [], []
    for k, (normal, across) in enumerate(FACES):
        n, u = np.array(normal, float), np.array(across, float)
        v = np.cross(n, u)
        corners.append((n + (2 * square[:, :1] - 1) * u + (2 * square[:, 1:] - 1) * v) * half)
        sides = 2.0 * np.array([np.abs(u) @ half, np.abs(v) @ half])
        uvs.append(square if tile_m is None else square * sides / tile_m)
        triangles += [(4 * k, 4 * k + 1, 4 * k + 2), (4 * k, 4 * k + 2, 4 * k + 3)]
    return np.concatenate(corners), np.concatenate(uvs), np.array(triangles, np.int64)


def _cylinder(radius: float, length: float) -> tuple[FloatArray, FloatArray, IntArray]:
    share = np.linspace(0.0, 1.0, ROUND + 1)
    circle = np.stack([np.cos(2 * np.pi * share), np.sin(2 * np.pi * share)], axis=-1)
    low, high = np.full((ROUND + 1, 1), -length / 2), np.full((ROUND + 1, 1), length / 2)
    rings = [np.hstack([radius * circle, z]) for z in (low, high)]
    wall_uv = [np.stack([share, np.full(ROUND + 1, v)], axis=-1) for v in (0.0, 1.0)]
    caps = [np.vstack([[[0.0, 0.0, float(ring[0, 2])]], ring]) for ring in rings]
    cap_uv = np.vstack([[[0.5, 0.5]], 0.5 + 0.5 * circle])
    k = np.arange(ROUND)
    wall = np.concatenate(
        [
            np.stack([k, k + 1, k + ROUND + 2], -1),
            np.stack([k, k + ROUND + 2, k + ROUND + 1], -1),
        ]
    )
    fan = np.stack([np.zeros(ROUND, int), k + 1, k + 2], -1)
    first = 2 * (ROUND + 1)
    triangles = np.concatenate([wall, first + fan[:, ::-1], first + ROUND + 2 + fan])
    return np.concatenate([*rings, *caps]), np.concatenate([*wall_uv, cap_uv, cap_uv]), triangles


def _sphere(radius: float) -> tuple[FloatArray, FloatArray, IntArray]:
    rows = ROUND // 2 + 1
    down, around = np.meshgrid(np.linspace(0.0, 1.0, rows), np.linspace(0.0, 1.0, ROUND + 1), indexing="ij")
    polar, azimuth = np.pi * down, 2 * np.pi * around
    unit = np.stack(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=-1
    )
    uvs = np.stack([around, 1.0 - down], axis=-1)
    triangles = grid_triangles(rows, ROUND + 1)[:, ::-1].astype(np.int64)
    return radius * unit.reshape(-1, 3), uvs.reshape(-1, 2), triangles
