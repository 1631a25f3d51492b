"""A whole glTF scene -> entities: nodes that are things, and what is larger than a thing by its children."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from simulator.importing.entities import Body, Entity, FloatArray, Scene, Shape
from simulator.importing.meshes.entity_surfaces import EntitySurfaces
from simulator.importing.meshes.surfaces import Surface

Y_TO_Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
"""glTF's y is up, its -z ahead becomes y."""
THING_M = 5.0
"""What is longer is no thing but a place, whose parts are things; chosen: longer than a sofa or a shelf."""


def read_gltf(path: Path, surfaces: EntitySurfaces) -> Scene:
    """Read a scene; its textures are read with it.

    Raises:
        WorldImportError: it is not glTF, or damaged.
    """
    read = surfaces.files.read(path)
    tree = NodeTree(surfaces.files.parents[path], read)
    return Scene(tuple(_entity(path, name, leaves) for name, leaves in _things(tree)))


class NodeTree:
    """Names of a scene's nodes with their children, and the surfaces of each."""

    def __init__(self, parents: dict[str, str], surfaces: list[Surface]) -> None:
        """Take the parent of each node, and all surfaces."""
        self._children: dict[str, list[str]] = {}
        for child, parent in parents.items():
            self._children.setdefault(parent, []).append(child)
        roots = [parent for parent in self._children if parent not in parents]
        self._own: dict[str, list[Surface]] = {}
        for surface in surfaces:
            self._own.setdefault(surface.node, []).append(surface)
        self.roots = roots or list(self._own)

    def children(self, node: str) -> list[str]:
        """Nodes directly below."""
        return self._children.get(node, [])

    def own(self, node: str) -> list[Surface]:
        """Surfaces of the node itself."""
        return self._own.get(node, [])

    def below(self, node: str) -> list[Surface]:
        """Surfaces of a node and everything below it."""
        found, open_ = list(self.own(node)), list(self.children(node))
        while open_:
            one = open_.pop()
            found += self.own(one)
            open_ += self.children(one)
        return found


def _things(tree: NodeTree) -> Iterator[tuple[str, list[Surface]]]:
    """Name and surfaces of each thing; what all hangs on is none, however small."""
    open_ = list(tree.roots)
    while len(open_) == 1 and not tree.own(open_[0]) and tree.children(open_[0]):
        open_ = tree.children(open_[0])
    open_ = open_[::-1]
    while open_:
        node = open_.pop()
        every = tree.below(node)
        if not every:
            continue
        points = np.concatenate([surface.vertices for surface in every])
        children = tree.children(node)
        if not children or np.ptp(points, axis=0)[[0, 2]].max() <= THING_M:
            yield node, every
            continue
        if tree.own(node):
            yield node, tree.own(node)
        open_ += reversed(children)


def _entity(path: Path, name: str, surfaces: list[Surface]) -> Entity:
    """A thing whose origin is below the middle of it."""
    points = np.concatenate([surface.vertices for surface in surfaces]) @ Y_TO_Z_UP[:3, :3].T
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    pose: FloatArray = np.eye(4)
    pose[:2, 3] = middle[:2]
    own = np.linalg.inv(pose) @ Y_TO_Z_UP
    names = dict.fromkeys(surface.node for surface in surfaces)
    shapes = tuple(Shape(path, own, node=node) for node in names)
    return Entity(name, "", pose, (Body(name, np.eye(4), shapes, shapes),))
