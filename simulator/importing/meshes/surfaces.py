"""Triangles with a look, wherever they were read from. Pure."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Pixels = npt.NDArray[np.uint8]
Rgba = tuple[float, float, float, float]
WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)
GLASS = 0.5
"""Less opaque than this is looked through: it is felt, not seen. Chosen: a camera sees what is behind."""


@dataclass(frozen=True)
class Look:
    """How a surface looks.

    Attributes:
        colour: RGB and opacity, 0 to 1, gamma-encoded; a picture is multiplied with it.
        picture: (height, width, 3) RGB or (height, width, 4) RGBA bytes, row 0 at the top; it has holes where
            it is less than half opaque.
        two_sided: whether its back is seen.
    """

    colour: Rgba = WHITE
    picture: Pixels | None = None
    two_sided: bool = False


@dataclass(frozen=True)
class Surface:
    """Triangles of one look in one node of a file, metres.

    Attributes:
        node: name of the node or geometry.
        vertices: (n, 3).
        triangles: (m, 3) counter-clockwise from the front.
        look: of all of it.
        uvs: (n, 2), v upwards; None without a picture.
        colours: (n, 3) RGB bytes of the vertices, gamma-encoded.
    """

    node: str
    vertices: FloatArray
    triangles: IntArray
    look: Look = Look()
    uvs: FloatArray | None = None
    colours: Pixels | None = None

    def moved(self, matrix: FloatArray) -> "Surface":
        """The same elsewhere, (4, 4); a mirrored one keeps its fronts in front."""
        turned = np.linalg.det(matrix[:3, :3]) < 0
        return replace(
            self,
            vertices=self.vertices @ matrix[:3, :3].T + matrix[:3, 3],
            triangles=self.triangles[:, ::-1] if turned else self.triangles,
        )


def triangles_of(surfaces: Iterable[Surface]) -> FloatArray:
    """Corners of all triangles, (n, 3, 3) metres."""
    found = [surface.vertices[surface.triangles] for surface in surfaces]
    return np.concatenate(found) if found else np.zeros((0, 3, 3))
