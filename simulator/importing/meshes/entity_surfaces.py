"""What is seen and felt of an entity -> surfaces in its own frame."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from simulator.importing.entities import Drawn, Paint, Primitive, Shape, WorldImportError
from simulator.importing.meshes.mesh_files import MeshFiles
from simulator.importing.meshes.pictures import Pictures
from simulator.importing.meshes.primitives import surface_of
from simulator.importing.meshes.surfaces import WHITE, Look, Surface

TILE_M = 2.0
"""After so many metres a texture drawn here repeats on a box; chosen: boards and bricks have their size."""


class EntitySurfaces:
    """Makes surfaces of shapes; reads each file once."""

    def __init__(self) -> None:
        """Nothing is read yet."""
        self.pictures = Pictures()
        self.files = MeshFiles(self.pictures)

    def of(self, shapes: Iterable[Shape]) -> list[Surface]:
        """Surfaces of all shapes, in the frame in which they are given.

        Raises:
            WorldImportError: a file cannot be used, or has no node of the name that is meant.
        """
        return [surface.moved(shape.pose) for shape in shapes for surface in self._shape(shape)]

    def _shape(self, shape: Shape) -> list[Surface]:
        if isinstance(shape.source, Primitive):
            look = self._painted(Look(), shape.paint, shape.name)
            tile_m = TILE_M if isinstance(shape.paint.picture, Drawn) else None
            return [surface_of(shape.source, look, shape.name, tile_m)]
        surfaces = self.files.read(shape.source)
        if shape.node is not None:
            surfaces = _only(surfaces, shape.node, shape.source)
        scale = np.diag([*shape.scale, 1.0])
        return [
            replace(
                surface.moved(scale),
                node=f"{shape.name} {surface.node}".strip(),
                look=self._painted(surface.look, shape.paint, shape.name),
            )
            for surface in surfaces
        ]

    def _painted(self, look: Look, paint: Paint, user: str) -> Look:
        """A look with what the world says over what the file says."""
        if paint.picture is not None:
            pixels = self.pictures.at(paint.picture, user)
            if pixels is not None:
                look = Look(WHITE, pixels[..., :3], look.two_sided)
            elif paint.colour is not None:
                look = Look(paint.colour, None, look.two_sided)
        elif paint.colour is not None:
            look = Look(paint.colour, None, look.two_sided)
        r, g, b, a = look.colour
        return replace(look, colour=(r, g, b, a * paint.opacity), two_sided=look.two_sided or paint.two_sided)


def _only(surfaces: list[Surface], node: str, path: Path) -> list[Surface]:
    found = [surface for surface in surfaces if surface.node == node]
    if not found:
        known = ", ".join(dict.fromkeys(surface.node for surface in surfaces))[:200]
        raise WorldImportError(f"{path} has no submesh {node!r:.60}; it has {known}")
    return found
