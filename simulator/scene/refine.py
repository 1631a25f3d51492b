"""Large triangles -> small ones, as light is stored at the vertices. Pure numpy."""

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import Mesh

ROUNDS = 10


def refined(mesh: Mesh, longest_m: float, most: int) -> Mesh:
    """Split edges in the middle until none is longer than `longest_m`, or there are `most` triangles.

    Both sides of an edge are split alike, so no gaps open.
    """
    for _ in range(ROUNDS):
        edges = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1)  # ab, bc, ca
        ends = mesh.vertices[edges]
        long = np.linalg.norm(ends[..., 0, :] - ends[..., 1, :], axis=-1) > longest_m
        if not long.any() or len(mesh.triangles) + long.sum() > most:
            return mesh
        mesh = _split(mesh, edges, long)
    return mesh


def _split(mesh: Mesh, edges: npt.NDArray[np.uint32], long: npt.NDArray[np.bool_]) -> Mesh:
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


def _pieces(
    triangles: npt.NDArray[np.uint32], middle: npt.NDArray[np.uint32], long: npt.NDArray[np.bool_]
) -> npt.NDArray[np.uint32]:
    """Two, three or four triangles for one with as many long edges plus one."""
    count = long.sum(axis=1)
    # Turn each triangle so that its one long edge, or its one short edge, comes first.
    first = np.where(count == 1, np.argmax(long, axis=1), np.argmin(long, axis=1))
    turn = (first[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(triangles, turn, axis=1).T
    ab, bc, ca = np.take_along_axis(middle, turn, axis=1).T
    one, two, three = count == 1, count == 2, count == 3

    def rows(chosen: npt.NDArray[np.bool_], *corners: npt.NDArray[np.uint32]) -> npt.NDArray[np.uint32]:
        return np.stack([corner[chosen] for corner in corners], axis=-1)

    return np.concatenate(
        [
            triangles[count == 0],
            rows(one, a, ab, c), rows(one, ab, b, c),
            rows(two, bc, c, ca), rows(two, a, b, bc), rows(two, a, bc, ca),
            rows(three, a, ab, ca), rows(three, ab, b, bc), rows(three, ca, bc, c), rows(three, ab, bc, ca),
        ]
    )  # fmt: skip
