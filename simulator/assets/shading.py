"""Looks of triangles without a texture of their own, and normals. Pure numpy."""

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import Mesh

FloatArray = npt.NDArray[np.floating]
CREASE_COS = float(np.cos(np.deg2rad(40.0)))
SMALLEST_AREA = 1e-14  # of the square of the model's size: slivers by rounding
MOST_FACES = 64  # at one place; further ones do not count


def creased(
    vertices: FloatArray, triangles: npt.NDArray[np.integer], uvs: FloatArray | None
) -> tuple[Mesh, npt.NDArray[np.int64]]:
    """Give triangles normals: smooth where faces meet at less than 40 degrees, sharp elsewhere.

    Files often carry no normals or wrong ones, and light is computed at the vertices.

    Returns:
        The mesh, and the vertex of the input that each of its vertices comes from. Slivers are left out.
    """
    corners = vertices[triangles].astype(np.float64)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(cross, axis=1)
    kept = area > SMALLEST_AREA * max(1.0, float(np.ptp(vertices)) ** 2)
    triangles, cross = triangles[kept], cross[kept]
    _, place = np.unique(np.asarray(vertices, np.float32), axis=0, return_inverse=True)
    corner_normals = _smoothed(place.reshape(-1)[triangles].ravel(), np.repeat(cross, 3, axis=0))
    normals = corner_normals.astype(np.float32)
    rows = np.concatenate([triangles.reshape(-1, 1).astype(np.float64), np.round(normals, 3)], axis=1)
    _, first, back = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    source = triangles.reshape(-1)[first].astype(np.int64)
    uv = np.zeros((len(source), 2), np.float32) if uvs is None else uvs[source].astype(np.float32)
    mesh = Mesh(
        vertices[source].astype(np.float32), normals[first], uv, back.reshape(-1, 3).astype(np.uint32)
    )
    return mesh, source


def _smoothed(places: npt.NDArray[np.integer], cross: FloatArray) -> npt.NDArray[np.float64]:
    """Normals of corners: sums over the faces at the same place that are turned by less than the crease.

    Args:
        places: (n,) place of each corner.
        cross: (n, 3) normal of its face, as long as the face is large.
    """
    order = np.argsort(places, kind="stable")
    place, weighted = places[order], np.asarray(cross, np.float64)[order]
    unit = weighted / np.linalg.norm(weighted, axis=1, keepdims=True)
    total = weighted.copy()
    for step in range(1, min(MOST_FACES, len(place))):
        same = np.flatnonzero(place[step:] == place[:-step])
        if not len(same):
            break
        one = same[(unit[same] * unit[same + step]).sum(axis=1) > CREASE_COS]
        total[one] += weighted[one + step]
        total[one + step] += weighted[one]
    total /= np.linalg.norm(total, axis=1, keepdims=True)
    found = np.empty_like(total)
    found[order] = total
    return found


def painted(mesh: Mesh, colours: npt.NDArray[np.uint8]) -> tuple[Mesh, npt.NDArray[np.uint8]]:
    """Show colours of vertices by a picture: each kind of triangle has a cell of 2 x 2 texels.

    Bilinear sampling between the middles of three texels gives the same shades as interpolating between
    three corners, so the shader needs no colours.

    Args:
        mesh: its uv are replaced.
        colours: (n, 3) RGB bytes of the vertices.

    Returns:
        The mesh with vertices of its own for each triangle, and the picture.
    """
    looks, cell = np.unique(colours[mesh.triangles].reshape(-1, 9), axis=0, return_inverse=True)
    a, b, c = (looks[:, k : k + 3].astype(np.int16) for k in (0, 3, 6))
    side = int(np.ceil(np.sqrt(len(looks))))
    cells = np.zeros((side * side, 2, 2, 3), np.uint8)
    cells[: len(looks)] = np.stack([a, b, c, np.clip(b + c - a, 0, 255)], axis=1).reshape(-1, 2, 2, 3)
    picture = cells.reshape(side, side, 2, 2, 3).transpose(0, 2, 1, 3, 4).reshape(2 * side, 2 * side, 3)
    row, column = np.divmod(cell.reshape(-1), side)
    middle = np.stack([column, row], axis=-1)[:, None] * 2.0 + np.array([[0.5, 0.5], [1.5, 0.5], [0.5, 1.5]])
    uv = (middle / (2 * side)).reshape(-1, 2).astype(np.float32)
    flat = mesh.triangles.reshape(-1)
    own = Mesh(
        mesh.vertices[flat], mesh.normals[flat], uv, np.arange(len(flat), dtype=np.uint32).reshape(-1, 3)
    )
    return own, np.ascontiguousarray(picture)
