"""Points spread over the triangles of a mesh. Pure numpy."""

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import Mesh

MOST_STEPS = 60


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
