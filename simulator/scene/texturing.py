"""How densely faces are cut into triangles, and which part of a texture they show. Pure numpy."""

from typing import Any

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import FloatArray
from simulator.scene.parts import Part

AnyFloat = npt.NDArray[np.floating[Any]]
# Light is stored at the vertices, so these decide how sharp shadows are; chosen by eye, decision 0008.
GRAIN_M = 0.36  # longest edge of large faces
GROUND_GRAIN_M = 0.2  # floors and rugs carry the shadows of everything that stands on them
THIN_GRAIN_M, THIN_M = 0.9, 0.15  # on narrow faces, along which light hardly changes


def edge_vertices(
    length: float, across: float = 1.0, ground: bool = False, grain: float | None = None
) -> int:
    """Vertices along an edge of a face that is `across` wide."""
    if grain is None:
        grain = GROUND_GRAIN_M if ground else GRAIN_M if across > THIN_M else THIN_GRAIN_M
    return max(2, int(np.ceil(length / grain)) + 1)


def stretched(part: Part, u: AnyFloat, v: AnyFloat) -> FloatArray:
    """Coordinates 0..1 -> the part's window of the texture; v counts from the top."""
    u0, v0, u1, v1 = part.uv
    return np.stack([u0 + (u1 - u0) * u, v0 + (v1 - v0) * v], axis=-1).astype(np.float32)


def texture_offset(part: Part) -> FloatArray:
    """Each part samples its own region of a tiled texture, so that no two boards look the same."""
    x, y, z = part.centre_m if part.texture_at_m is None else part.texture_at_m
    return np.array([0.37 * x + 0.71 * y + 0.13 * z, 0.53 * x - 0.29 * y + 0.41 * z], np.float32)
