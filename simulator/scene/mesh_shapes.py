"""Parts -> triangles: vertices, outward normals and texture coordinates. Pure numpy."""

import numpy as np

from simulator.scene.curved_shapes import cushion, drape, ellipsoid, leaf
from simulator.scene.meshes import Mesh, grid_triangles, joined
from simulator.scene.parts import Part, rotation_of
from simulator.scene.texturing import AnyFloat, edge_vertices, stretched, texture_offset

SIDES, SLIM_SIDES, SLIM_M = 16, 8, 0.06  # of a cylinder, and of one with a radius below this; chosen by eye
ON_FLOOR_M = 0.02  # a face this low is floor or rug
LARGE_M = 2.4  # textures of larger boxes run on from one to the next; chosen: more than any furniture's side
MASONRY = ("bricks", "paving")
"""Laid in level courses that go on from one part to the next, whatever the shape of these."""


def mesh_of(part: Part) -> Mesh:
    """Triangles of a part in its world (or body) frame."""
    local = {
        "box": _box,
        "cylinder": _cylinder,
        "ellipsoid": ellipsoid,
        "cushion": cushion,
        "drape": drape,
        "leaf": leaf,
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


def _box(part: Part) -> Mesh:
    return joined([_box_face(part, axis, sign) for axis in range(3) for sign in (-1.0, 1.0)])


def _box_face(part: Part, axis: int, sign: float) -> Mesh:
    half = np.array(part.size_m, np.float32) / 2
    # Right and up of the picture as seen from outside the face.
    up = 2 if axis != 2 else 0
    right = 3 - axis - up
    normal = np.zeros(3, np.float32)
    normal[axis] = sign
    lift = np.eye(3, dtype=np.float32)[up]
    side = np.cross(lift, normal).astype(np.float32)
    ground = axis == 2 and part.centre_m[2] + half[2] < ON_FLOOR_M
    n_u = edge_vertices(2 * half[right], 2 * half[up], ground, part.grain_m)
    n_v = edge_vertices(2 * half[up], 2 * half[right], ground, part.grain_m)
    s, t = np.meshgrid(np.linspace(-1, 1, n_u, dtype=np.float32), np.linspace(1, -1, n_v, dtype=np.float32))
    points = normal * half[axis] + s[..., None] * side * half[right] + t[..., None] * lift * half[up]
    points = points.reshape(-1, 3)
    large = max(part.size_m) > LARGE_M or part.material.kind in MASONRY
    if part.tile_m is None:
        uv = stretched(part, (s.ravel() + 1) / 2, (1 - t.ravel()) / 2)
    else:
        world = points + np.array(part.centre_m, np.float32) if large else points
        shift = np.zeros(2, np.float32) if large else texture_offset(part)
        uv = np.asarray(np.stack([world @ side, -(world @ lift)], axis=-1) / part.tile_m + shift, np.float32)
        if 2 * half[right] < 2 * half[up] and not large:
            uv = uv[:, ::-1]  # grain runs along the longer side
    normals = np.tile(normal, (len(points), 1))
    return Mesh(points, normals, uv.astype(np.float32), grid_triangles(n_v, n_u)[:, ::-1])


def _cylinder(part: Part) -> Mesh:
    rx, ry, half = part.size_m[0] / 2, part.size_m[1] / 2, part.size_m[2] / 2
    sides = SIDES if rx > SLIM_M else SLIM_SIDES
    angles = np.linspace(0, 2 * np.pi, sides + 1, dtype=np.float32)
    levels = np.linspace(-1, 1, edge_vertices(2 * half, 2 * rx), dtype=np.float32)
    scale = 1 + (part.taper - 1) * (levels + 1) / 2
    unit = np.stack([np.cos(angles) * rx, np.sin(angles) * ry], axis=-1)
    ring = unit[None] * scale[:, None, None]
    heights = np.broadcast_to((levels * half)[:, None, None], (len(levels), sides + 1, 1))
    wall = np.concatenate([ring, heights], axis=-1).reshape(-1, 3)
    outward = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1)
    normals = np.tile(outward, (len(levels), 1))
    u, v = np.tile(angles / (2 * np.pi), len(levels)), np.repeat((1 - levels) / 2, sides + 1)
    repeat = (1.0, 1.0)
    if part.tile_m is not None:
        repeat = (max(1.0, round(2 * np.pi * rx / part.tile_m)), 2 * half / part.tile_m)
    uv = np.stack([u * repeat[0], v * repeat[1]], axis=-1).astype(np.float32)
    triangles = grid_triangles(len(levels), sides + 1)
    body = Mesh(wall.astype(np.float32), normals.astype(np.float32), uv, triangles)
    tile_m = 2 * rx if part.tile_m is None else part.tile_m
    return joined([body, _cap(ring[0], -1.0, half, tile_m), _cap(ring[-1], 1.0, half, tile_m)])


def _cap(rim: AnyFloat, sign: float, half: float, tile_m: float) -> Mesh:
    """The bottom (sign -1) or top of a cylinder with this rim, (sides + 1, 2)."""
    sides = len(rim) - 1
    points = np.concatenate([[[0.0, 0.0]], rim]).astype(np.float32)
    cap = np.concatenate([points, np.full((len(points), 1), sign * half)], axis=-1).astype(np.float32)
    around = np.arange(1, sides + 1, dtype=np.uint32)
    fan = np.stack([np.zeros_like(around), around, around + np.uint32(1)], axis=-1)
    normals = np.tile(np.array([0, 0, sign], np.float32), (len(cap), 1))
    return Mesh(cap, normals, (points / tile_m + 0.5).astype(np.float32), fan if sign > 0 else fan[:, ::-1])
