"""Triangle meshes: data, joining, refining, sampling, dropping what no camera can see. Pure numpy."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.uint32]
BoolArray = npt.NDArray[np.bool_]
MOST_ROUNDS = 10
"""Edges are halved so often at most: the longest, furniture.catalogue.MOST_SIZE_M, become 0.4 m."""
MOST_STEPS = 60
"""Points along an edge at most; chosen: edges were refined before, this bounds what a file may ask for."""


@dataclass(frozen=True)
class Mesh:
    """Triangles: (n, 3) vertices in metres, (n, 3) unit normals, (n, 2) uv, (m, 3) indices."""

    vertices: FloatArray
    normals: FloatArray
    uvs: FloatArray
    triangles: IntArray


def joined(meshes: list[Mesh]) -> Mesh:
    """One mesh of several."""
    offsets = np.cumsum([0, *[len(m.vertices) for m in meshes[:-1]]])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.uvs for m in meshes]),
        np.concatenate([m.triangles + np.uint32(o) for m, o in zip(meshes, offsets, strict=True)]),
    )


def two_sided(front: Mesh) -> Mesh:
    """The mesh with a back a millimetre behind it."""
    back = Mesh(front.vertices - 0.001 * front.normals, -front.normals, front.uvs, front.triangles[:, ::-1])
    return joined([front, back])


def grid_triangles(rows: int, columns: int) -> IntArray:
    """Two counter-clockwise triangles per cell of a (rows, columns) grid of vertices, row by row."""
    index = np.arange(rows * columns, dtype=np.uint32).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def facing_any(mesh: Mesh, viewpoints: FloatArray) -> Mesh:
    """The triangles whose front is turned towards at least one of (k, 3) viewpoints.

    With the corners of all rooms at camera height as viewpoints this drops, exactly, what no camera there can
    see: undersides below the camera, tops above it, backs against walls.
    """
    corner = mesh.vertices[mesh.triangles[:, 0]]
    normal = np.cross(
        mesh.vertices[mesh.triangles[:, 1]] - corner, mesh.vertices[mesh.triangles[:, 2]] - corner
    )
    ahead = np.einsum("kmc,mc->km", viewpoints[:, None, :] - corner[None], normal)
    kept = mesh.triangles[(ahead > 0.0).any(axis=0)]
    used, back = np.unique(kept, return_inverse=True)
    return Mesh(
        mesh.vertices[used], mesh.normals[used], mesh.uvs[used], back.reshape(-1, 3).astype(np.uint32)
    )


def refined(mesh: Mesh, longest_m: float, most: int) -> Mesh:
    """Split edges in the middle until none is longer than `longest_m`, or there are `most` triangles.

    Both sides of an edge are split alike, so no gaps open.
    """
    for _ in range(MOST_ROUNDS):
        edges = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1)  # ab, bc, ca
        ends = mesh.vertices[edges]
        long = np.linalg.norm(ends[..., 0, :] - ends[..., 1, :], axis=-1) > longest_m
        if not long.any() or len(mesh.triangles) + long.sum() > most:
            return mesh
        mesh = _split(mesh, edges, long)
    return mesh


def _split(mesh: Mesh, edges: IntArray, long: BoolArray) -> Mesh:
    pairs, back = np.unique(np.sort(edges[long], axis=-1), axis=0, return_inverse=True)
    middle = np.zeros(long.shape, np.uint32)
    middle[long] = len(mesh.vertices) + back.reshape(-1)
    normals = mesh.normals[pairs].sum(axis=1)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return Mesh(
        np.concatenate([mesh.vertices, mesh.vertices[pairs].mean(axis=1)]),
        np.concatenate([mesh.normals, normals.astype(np.float32)]),
        np.concatenate([mesh.uvs, mesh.uvs[pairs].mean(axis=1)]),
        _pieces(mesh.triangles, middle, long),
    )


def _pieces(triangles: IntArray, middle: IntArray, long: BoolArray) -> IntArray:
    """Two, three or four triangles for one with as many long edges plus one."""
    count = long.sum(axis=1)
    # Turn each triangle so that its one long edge, or its one short edge, comes first.
    first = np.where(count == 1, np.argmax(long, axis=1), np.argmin(long, axis=1))
    turn = (first[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(triangles, turn, axis=1).T
    ab, bc, ca = np.take_along_axis(middle, turn, axis=1).T
    one, two, three = count == 1, count == 2, count == 3

    def rows(chosen: BoolArray, *corners: IntArray) -> IntArray:
        return np.stack([corner[chosen] for corner in corners], axis=-1)

    return np.concatenate(
        [
            triangles[count == 0],
            rows(one, a, ab, c), rows(one, ab, b, c),
            rows(two, bc, c, ca), rows(two, a, b, bc), rows(two, a, bc, ca),
            rows(three, a, ab, ca), rows(three, ab, b, bc), rows(three, ca, bc, c), rows(three, ab, bc, ca),
        ]
    )  # fmt: skip


def surface_points(mesh: Mesh, spacing_m: float) -> npt.NDArray[np.float64]:
    """Points no further apart than `spacing_m` along the edges of each triangle, (n, 3)."""
    corners = mesh.vertices[mesh.triangles].astype(np.float64)
    longest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=-1).max(axis=1)
    steps = np.clip(np.ceil(longest / spacing_m).astype(int), 1, MOST_STEPS)
    found = []
    for count in np.unique(steps):
        i, j = np.divmod(np.arange((count + 1) ** 2), count + 1)
        weights = np.stack([count - i - j, i, j], axis=-1)[i + j <= count] / count
        found.append((weights @ corners[steps == count]).reshape(-1, 3))
    return np.concatenate(found) if found else np.zeros((0, 3))
