"""Triangles of ellipsoids, cushions, hanging cloth and leaves; figures by eye. Pure numpy."""

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import Mesh, grid_triangles, two_sided
from simulator.scene.parts import Part
from simulator.scene.texturing import edge_vertices, stretched, texture_offset


def ellipsoid(part: Part) -> Mesh:
    """Ellipsoid in its box."""
    return _superellipsoid(part, 1.0, 6, 10)


def cushion(part: Part) -> Mesh:
    """Box with round edges: a superellipsoid of low exponent."""
    rows, columns = (9, 17) if max(part.size_m) > 0.5 else (8, 13)
    return _superellipsoid(part, 0.32, rows, columns)


def _superellipsoid(part: Part, exponent: float, rows: int, columns: int) -> Mesh:
    """Barr 1981: x = sgn(cos) |cos|^e and so on; samples gather where the surface bends."""
    half = np.array(part.size_m, np.float32) / 2
    lat = np.linspace(-np.pi / 2, np.pi / 2, rows)[:, None] * np.ones((1, columns))
    lon = np.linspace(-np.pi, np.pi, columns)[None, :] * np.ones((rows, 1))

    def power(value: npt.NDArray[np.float64], e: float) -> npt.NDArray[np.float64]:
        return np.asarray(np.sign(value) * np.abs(value) ** e)

    def surface(e: float) -> npt.NDArray[np.float64]:
        level = power(np.cos(lat), e)
        return np.stack(
            [level * power(np.cos(lon), e), level * power(np.sin(lon), e), power(np.sin(lat), e)], -1
        )

    unit, gradient = surface(exponent), surface(2 - exponent)
    points = (unit * half).reshape(-1, 3).astype(np.float32)
    normals = (gradient / half).reshape(-1, 3)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    # Project the texture along the dominant normal axis of the whole cushion: seams stay at its thin edges.
    thin = int(np.argmin(part.size_m))
    a, b = [k for k in (1, 0, 2) if k != thin]
    if part.tile_m is None:
        uv = stretched(part, points[:, a] / part.size_m[a] + 0.5, 0.5 - points[:, b] / part.size_m[b])
    else:
        around = points[:, [a, b]] + 0.6 * points[:, [thin]] * np.array([0.5, 1.0], np.float32)
        uv = np.asarray(around / part.tile_m + texture_offset(part), np.float32)
    return Mesh(points, normals.astype(np.float32), uv.astype(np.float32), grid_triangles(rows, columns))


def drape(part: Part) -> Mesh:
    """Hanging cloth: waves along y, in front and behind; seen from both sides."""
    depth, width, height = part.size_m
    n_y, n_z = max(9, int(width / 0.032)), edge_vertices(height)
    s, t = np.meshgrid(np.linspace(-0.5, 0.5, n_y), np.linspace(0.5, -0.5, n_z))
    waves = max(2.0, width / 0.09)
    phase = 2 * np.pi * waves * s + 1.2 * np.sin(3 * t)
    flare = 1.0 + 0.12 * (0.5 - t)
    x, slope = 0.5 * depth * np.sin(phase), np.pi * depth * waves / width * np.cos(phase)
    points = np.stack([x, s * width * flare, t * height], axis=-1).reshape(-1, 3).astype(np.float32)
    normal = np.stack([np.ones_like(slope), -slope, np.zeros_like(slope)], axis=-1).reshape(-1, 3)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    tile = part.tile_m or max(width, height)
    uv = np.stack([(s * width * 1.8).ravel() / tile, (-t * height).ravel() / tile], axis=-1) + texture_offset(
        part
    )
    triangles = grid_triangles(n_z, n_y)[:, ::-1]
    return two_sided(Mesh(points, normal.astype(np.float32), uv.astype(np.float32), triangles))


def leaf(part: Part) -> Mesh:
    """Pointed leaf along x, drooping towards its tip; seen from both sides."""
    long, wide, droop = part.size_m
    s, t = np.meshgrid(np.linspace(-1, 1, 3), np.linspace(0, 1, 4))
    half = wide / 2 * np.sin(np.pi * np.clip(t * 0.92 + 0.05, 0, 1)) ** 0.8
    height = -droop * (t - 0.3) ** 2 + 0.12 * wide * np.abs(s)
    points = np.stack([(t - 0.5) * long, s * half, height], axis=-1).reshape(-1, 3).astype(np.float32)
    uv = stretched(part, ((s + 1) / 2).ravel().astype(np.float32), t.ravel().astype(np.float32))
    normals = np.tile(np.array([0, 0, 1], np.float32), (len(points), 1))
    return two_sided(Mesh(points, normals, uv, grid_triangles(4, 3)[:, ::-1]))
