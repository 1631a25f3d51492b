"""Triangle meshes: data, joining, dropping what no camera can see. Pure numpy."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.uint32]


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


def facing_any(mesh: Mesh, eyes: FloatArray) -> Mesh:
    """The triangles whose front is turned towards at least one of (k, 3) eye positions.

    With the corners of all rooms at camera height as eyes this drops, exactly, what no camera there can see:
    undersides below the camera, tops above it, backs against walls.
    """
    corner = mesh.vertices[mesh.triangles[:, 0]]
    normal = np.cross(
        mesh.vertices[mesh.triangles[:, 1]] - corner, mesh.vertices[mesh.triangles[:, 2]] - corner
    )
    ahead = np.einsum("kmc,mc->km", eyes[:, None, :] - corner[None], normal)
    kept = mesh.triangles[(ahead > 0.0).any(axis=0)]
    used, back = np.unique(kept, return_inverse=True)
    return Mesh(
        mesh.vertices[used], mesh.normals[used], mesh.uvs[used], back.reshape(-1, 3).astype(np.uint32)
    )
