"""A model read from a file: patches of triangles, each with its picture."""

from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import numpy.typing as npt

from simulator.scene.disk_cache import DiskCache
from simulator.scene.meshes import Mesh
from simulator.scene.parts import Picture, Piece

FloatArray = npt.NDArray[np.floating]
UpAxis = Literal["y", "z"]


class AssetError(ValueError):
    """A file cannot be used; the message says which, what was expected, what came, and what to do."""


@dataclass(frozen=True)
class Patch:
    """Triangles of one look, in the axes of the file and its unit.

    Attributes:
        mesh: vertices, normals, uv (v = 0 at the top) and triangles.
        picture: its texture.
        mapped: whether the file gave texture coordinates, so that another picture can take this one's place.
        two_sided: whether the file wants its back seen.
        seen: false for glass: it is looked through, but stops the robot.
    """

    mesh: Mesh
    picture: Picture
    mapped: bool
    two_sided: bool
    seen: bool = True


@dataclass(frozen=True)
class Model:
    """All patches of a file. The digest, of the content and of the files it names, is the identity.

    `kept` holds what was made of it, by options: a world is expanded several times. `cache` keeps on disk
    what takes longest.
    """

    digest: str
    name: str
    patches: tuple[Patch, ...] = field(compare=False, repr=False)
    kept: dict[Hashable, Piece] = field(default_factory=dict, compare=False, repr=False)
    cache: DiskCache = field(default_factory=DiskCache.none, compare=False, repr=False)

    def vertices(self) -> FloatArray:
        """All vertices, (n, 3), in the axes of the file."""
        return np.concatenate([patch.mesh.vertices for patch in self.patches])
