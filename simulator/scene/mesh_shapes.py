"""Parts -> triangles: vertices, outward normals and texture coordinates. Pure numpy."""

from typing import Any

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import FloatArray, IntArray, Mesh, joined
from simulator.scene.parts import Part, rotation_of

AnyFloat = npt.NDArray[np.floating[Any]]
GRAIN_M = 0.36  # longest edge of large faces: light is stored at the vertices
GROUND_GRAIN_M = 0.2  # floors and rugs carry the shadows of everything that stands on them
THIN_GRAIN_M = 0.9  # the same on narrow faces, along which light hardly changes
SIDES = 16


def mesh_of(part: Part) -> Mesh:
    """Triangles of a part in its world (or body) frame."""
    local = {
        "box": _box,
        "cylinder": _cylinder,
        "ellipsoid": _ellipsoid,
        "cushion": _cushion,
        "drape": _drape,
        "leaf": _leaf,
        "mesh": _from_file,
        "hull": _nothing,
    }[part.shape](part)
    rotation = rotation_of(part).astype(np.float32)
    return Mesh(
        local.vertices @ rotation.T + np.array(part.centre_m, np.float32),
        local.normals @ rotation.T,
        local.uvs,
        local.triangles,
    )


def _from_file(part: Part) -> Mesh:
    if part.geometry is None:
        raise ValueError("a part of shape 'mesh' needs its geometry, got None")
    return part.geometry.mesh


def _nothing(part: Part) -> Mesh:
    """Hulls are felt and not seen."""
    del part
    floats, corners = np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint32)
    return Mesh(floats, floats, np.zeros((0, 2), np.float32), corners)


def _grid(rows: int, columns: int) -> IntArray:
    """Two counter-clockwise triangles per cell of a (rows, columns) grid of vertices, row by row."""
    index = np.arange(rows * columns, dtype=np.uint32).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def _steps(length: float, across: float = 1.0, ground: bool = False, grain: float | None = None) -> int:
    """Vertices along an edge of a face that is `across` wide."""
    if grain is None:
        grain = GROUND_GRAIN_M if ground else GRAIN_M if across > 0.15 else THIN_GRAIN_M
    return max(2, int(np.ceil(length / grain)) + 1)


def _stretch(part: Part, u: AnyFloat, v: AnyFloat) -> FloatArray:
    """Coordinates 0..1 -> the part's window of the texture; v counts from the top."""
    u0, v0, u1, v1 = part.uv
    return np.stack([u0 + (u1 - u0) * u, v0 + (v1 - v0) * v], axis=-1).astype(np.float32)


def _offset(part: Part) -> FloatArray:
    """Each part samples its own region of a tiled texture, so that no two boards look the same."""
    x, y, z = part.centre_m
    return np.array([0.37 * x + 0.71 * y + 0.13 * z, 0.53 * x - 0.29 * y + 0.41 * z], np.float32)


def _box(part: Part) -> Mesh:
    half = np.array(part.size_m, np.float32) / 2
    faces = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            # Right and up of the picture as seen from outside the face.
            up = 2 if axis != 2 else 0
            right = 3 - axis - up
            normal = np.zeros(3, np.float32)
            normal[axis] = sign
            lift = np.eye(3, dtype=np.float32)[up]
            side = np.cross(lift, normal).astype(np.float32)
            ground = axis == 2 and part.centre_m[2] + half[2] < 0.02
            n_u = _steps(2 * half[right], 2 * half[up], ground, part.grain_m)
            n_v = _steps(2 * half[up], 2 * half[right], ground, part.grain_m)
            s, t = np.meshgrid(
                np.linspace(-1, 1, n_u, dtype=np.float32), np.linspace(1, -1, n_v, dtype=np.float32)
            )
            points = normal * half[axis] + s[..., None] * side * half[right] + t[..., None] * lift * half[up]
            points = points.reshape(-1, 3)
            if part.tile_m is None:
                uv = _stretch(part, (s.ravel() + 1) / 2, (1 - t.ravel()) / 2)
            else:
                world = points + np.array(part.centre_m, np.float32) if max(part.size_m) > 2.4 else points
                shift = np.zeros(2, np.float32) if max(part.size_m) > 2.4 else _offset(part)
                uv = np.asarray(
                    np.stack([world @ side, -(world @ lift)], axis=-1) / part.tile_m + shift, np.float32
                )
                if 2 * half[right] < 2 * half[up] and max(part.size_m) <= 2.4:
                    uv = uv[:, ::-1]  # grain runs along the longer side
            faces.append(
                Mesh(
                    points, np.tile(normal, (len(points), 1)), uv.astype(np.float32), _grid(n_v, n_u)[:, ::-1]
                )
            )
    return joined(faces)


def _cylinder(part: Part) -> Mesh:
    rx, ry, half = part.size_m[0] / 2, part.size_m[1] / 2, part.size_m[2] / 2
    sides = SIDES if rx > 0.06 else 8
    angles = np.linspace(0, 2 * np.pi, sides + 1, dtype=np.float32)
    levels = np.linspace(-1, 1, _steps(2 * half, 2 * rx), dtype=np.float32)
    scale = 1 + (part.taper - 1) * (levels + 1) / 2
    unit = np.stack([np.cos(angles) * rx, np.sin(angles) * ry], axis=-1)
    ring = unit[None] * scale[:, None, None]
    wall = np.concatenate(
        [ring, np.broadcast_to((levels * half)[:, None, None], (len(levels), sides + 1, 1))], axis=-1
    ).reshape(-1, 3)
    normals = np.tile(
        np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1), (len(levels), 1)
    )
    u, v = np.tile(angles / (2 * np.pi), len(levels)), np.repeat((1 - levels) / 2, sides + 1)
    repeat = (
        (1.0, 1.0)
        if part.tile_m is None
        else (max(1.0, round(2 * np.pi * rx / part.tile_m)), 2 * half / part.tile_m)
    )
    uv = np.stack([u * repeat[0], v * repeat[1]], axis=-1)
    pieces = [
        Mesh(
            wall.astype(np.float32),
            normals.astype(np.float32),
            uv.astype(np.float32),
            _grid(len(levels), sides + 1),
        )
    ]
    for sign, rim in ((-1.0, ring[0]), (1.0, ring[-1])):
        points = np.concatenate([[[0.0, 0.0]], rim]).astype(np.float32)
        cap = np.concatenate([points, np.full((len(points), 1), sign * half)], axis=-1).astype(np.float32)
        fan = np.stack([np.zeros(sides), np.arange(1, sides + 1), np.arange(2, sides + 2)], axis=-1).astype(
            np.uint32
        )
        size = 2 * rx if part.tile_m is None else part.tile_m
        pieces.append(
            Mesh(
                cap,
                np.tile(np.array([0, 0, sign], np.float32), (len(cap), 1)),
                (points / size + 0.5).astype(np.float32),
                fan if sign > 0 else fan[:, ::-1],
            )
        )
    return joined(pieces)


def _ellipsoid(part: Part) -> Mesh:
    return _superellipsoid(part, 1.0, 6, 10)


def _cushion(part: Part) -> Mesh:
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

    unit = np.stack(
        [
            power(np.cos(lat), exponent) * power(np.cos(lon), exponent),
            power(np.cos(lat), exponent) * power(np.sin(lon), exponent),
            power(np.sin(lat), exponent),
        ],
        -1,
    )
    gradient = np.stack(
        [
            power(np.cos(lat), 2 - exponent) * power(np.cos(lon), 2 - exponent),
            power(np.cos(lat), 2 - exponent) * power(np.sin(lon), 2 - exponent),
            power(np.sin(lat), 2 - exponent),
        ],
        -1,
    )
    points = (unit * half).reshape(-1, 3).astype(np.float32)
    normals = (gradient / half).reshape(-1, 3)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    # Project the texture along the dominant normal axis of the whole cushion: seams stay at its thin edges.
    thin = int(np.argmin(part.size_m))
    a, b = [k for k in (1, 0, 2) if k != thin]
    if part.tile_m is None:
        uv = _stretch(part, points[:, a] / part.size_m[a] + 0.5, 0.5 - points[:, b] / part.size_m[b])
    else:
        around = points[:, [a, b]] + 0.6 * points[:, [thin]] * np.array([0.5, 1.0], np.float32)
        uv = np.asarray(around / part.tile_m + _offset(part), np.float32)
    return Mesh(points, normals.astype(np.float32), uv.astype(np.float32), _grid(rows, columns))


def _drape(part: Part) -> Mesh:
    """Hanging cloth: waves along y, in front and behind; seen from both sides."""
    depth, width, height = part.size_m
    n_y, n_z = max(9, int(width / 0.032)), _steps(height)
    s, t = np.meshgrid(np.linspace(-0.5, 0.5, n_y), np.linspace(0.5, -0.5, n_z))
    waves = max(2.0, width / 0.09)
    phase = 2 * np.pi * waves * s + 1.2 * np.sin(3 * t)
    flare = 1.0 + 0.12 * (0.5 - t)
    x, slope = 0.5 * depth * np.sin(phase), np.pi * depth * waves / width * np.cos(phase)
    points = np.stack([x, s * width * flare, t * height], axis=-1).reshape(-1, 3).astype(np.float32)
    normal = np.stack([np.ones_like(slope), -slope, np.zeros_like(slope)], axis=-1).reshape(-1, 3)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    tile = part.tile_m or max(width, height)
    uv = np.stack([(s * width * 1.8).ravel() / tile, (-t * height).ravel() / tile], axis=-1) + _offset(part)
    front = Mesh(points, normal.astype(np.float32), uv.astype(np.float32), _grid(n_z, n_y)[:, ::-1])
    return joined([front, _backside(front)])


def _leaf(part: Part) -> Mesh:
    """Pointed leaf along x, drooping towards its tip; seen from both sides."""
    long, wide, droop = part.size_m
    s, t = np.meshgrid(np.linspace(-1, 1, 3), np.linspace(0, 1, 4))
    half = wide / 2 * np.sin(np.pi * np.clip(t * 0.92 + 0.05, 0, 1)) ** 0.8
    points = (
        np.stack([(t - 0.5) * long, s * half, -droop * (t - 0.3) ** 2 + 0.12 * wide * np.abs(s)], axis=-1)
        .reshape(-1, 3)
        .astype(np.float32)
    )
    uv = _stretch(part, ((s + 1) / 2).ravel().astype(np.float32), t.ravel().astype(np.float32))
    front = Mesh(points, np.tile(np.array([0, 0, 1], np.float32), (len(points), 1)), uv, _grid(4, 3))
    front = Mesh(front.vertices, front.normals, front.uvs, front.triangles[:, ::-1])
    return joined([front, _backside(front)])


def _backside(mesh: Mesh) -> Mesh:
    return Mesh(mesh.vertices - 0.001 * mesh.normals, -mesh.normals, mesh.uvs, mesh.triangles[:, ::-1])
