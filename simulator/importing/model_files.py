"""Entities -> model files in a folder, equal ones once, and the pieces of furniture that show them."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

import numpy as np

from simulator.assets.solids import needs_sheets
from simulator.importing.contents import Thing
from simulator.importing.entities import Body, Entity, FloatArray, Shape, WorldImportError
from simulator.importing.meshes.cutting import heaps
from simulator.importing.meshes.entity_surfaces import EntitySurfaces
from simulator.importing.meshes.glb import glb_of
from simulator.importing.meshes.surfaces import Look, Surface, triangles_of
from simulator.scene.meshes import Mesh
from simulator.world.fields import MOST_M

GREY = (0.7, 0.7, 0.7, 1.0)
FOLDER = "models"
"""Beside the world file."""
THING_M = 5.0
"""A model of several links that is longer is no thing but a place, whose links are things. Chosen: longer
than a sofa or a shelf."""


class ModelFiles:
    """Writes the models of entities."""

    def __init__(self, into: Path, surfaces: EntitySurfaces, leave_out: bool) -> None:
        """Write into the folder of models below `into`.

        Args:
            into: folder of the world file.
            surfaces: reads what entities are made of.
            leave_out: whether a file that is broken is left out; what was is in `left_out`.
        """
        self._folder, self._surfaces, self._leave_out = into / FOLDER, surfaces, leave_out
        self._folder.mkdir(parents=True, exist_ok=True)
        self._files: dict[object, str] = {}
        self._outlines: dict[str | None, str] = {None: "none"}
        self._names: set[str] = set()
        self._stems: set[str] = set()
        self._triangles: list[FloatArray] = []
        self.left_out: list[str] = []

    def write(self, entity: Entity) -> list[Thing]:
        """Write the model files of an entity; the pieces of furniture that it becomes.

        Raises:
            WorldImportError: a mesh file cannot be used.
        """
        far_m = float(np.abs(entity.pose[:3, 3]).max())
        if far_m > MOST_M:
            self.left_out.append(f"model {entity.name!r:.60} lies {far_m:.0f} m away: left out")
            return []
        found = []
        for body in self._things(entity):
            told = len(self.left_out)
            seen, felt = self._read(body.seen), [_plain(surface) for surface in self._read(body.felt)]
            if not seen and not felt:
                continue
            lost = not seen and (body.lost or len(self.left_out) > told)
            if lost:  # better grey than unseen
                seen = [replace(surface, look=Look(GREY)) for surface in felt]
            pose = entity.pose @ body.pose
            for surfaces in (seen, felt):
                self._triangles.append(triangles_of(surfaces) @ pose[:3, :3].T + pose[:3, 3])
            stem = body.name if entity.model == "" else entity.model
            for files in self._pairs(seen, felt, body, stem or "model", lost):
                found.append(Thing(_unique(body.name or stem or "model", self._names), *files, pose))
        return found

    def triangles(self) -> FloatArray:
        """All triangles so far, in the frame of the imported file, (n, 3, 3)."""
        return np.concatenate(self._triangles) if self._triangles else np.zeros((0, 3, 3))

    def _things(self, entity: Entity) -> list[Body]:
        """The bodies of an entity by themselves where it is a place, else all as one."""
        if len(entity.bodies) == 1:
            return [replace(entity.bodies[0], name=entity.name)]
        if not entity.jointed and self._length_m(entity) > THING_M:
            return [replace(body, name=f"{entity.name} {body.name}") for body in entity.bodies]
        seen = tuple(replace(s, pose=b.pose @ s.pose) for b in entity.bodies for s in b.seen)
        felt = tuple(replace(s, pose=b.pose @ s.pose) for b in entity.bodies for s in b.felt)
        lost = any(body.lost for body in entity.bodies)
        return [Body(entity.name, np.eye(4), seen, felt, lost)]

    def _length_m(self, entity: Entity) -> float:
        corners = [
            triangles_of(self._read((*body.seen, *body.felt))).reshape(-1, 3) @ body.pose[:3, :3].T
            + body.pose[:3, 3]
            for body in entity.bodies
        ]
        points = np.concatenate(corners)
        return float(np.ptp(points[:, :2], axis=0).max()) if len(points) else 0.0

    def _read(self, shapes: Sequence[Shape]) -> list[Surface]:
        found = []
        for shape in shapes:
            try:
                found += self._surfaces.of([shape])
            except WorldImportError as error:
                if not self._leave_out:
                    raise
                self.left_out.append(str(error))
        return found

    def _pairs(
        self, seen: list[Surface], felt: list[Surface], body: Body, stem: str, lost: bool
    ) -> Iterator[tuple[str, str | None, str]]:
        """Files of what is seen and felt, and the outline this needs; one of each but for the largest."""
        seen_key, felt_key = (tuple(s.key() for s in shapes) for shapes in (body.seen, body.felt))
        key = ("lost", felt_key) if lost else ("seen", seen_key)
        shown_heaps, felt_heaps = heaps(seen), heaps(felt)
        hollow = "concave" if len(felt_heaps) == 1 else "sheets"  # a piece of a room is no room by itself
        for k, (shown, stops) in enumerate(zip_longest(shown_heaps, felt_heaps)):
            felt_file = None if stops is None else self._file(stops, ("felt", k, felt_key), f"{stem}-felt")
            file = felt_file if shown is None else self._file(shown, (*key, k), stem)
            if felt_file not in self._outlines:
                needed = needs_sheets([_mesh(surface) for surface in felt])
                self._outlines[felt_file] = hollow if needed else "convex"
            yield str(file), felt_file, self._outlines[felt_file]

    def _file(self, surfaces: list[Surface], key: object, stem: str) -> str:
        if key not in self._files:
            name = f"{_unique(_slug(stem), self._stems)}.glb"
            (self._folder / name).write_bytes(glb_of(surfaces))
            self._files[key] = f"{FOLDER}/{name}"
        return self._files[key]


def _plain(surface: Surface) -> Surface:
    """Without texture and colours: what is felt is not seen, not even where nothing else is there."""
    return Surface(surface.node, surface.vertices, surface.triangles, Look((0.5, 0.5, 0.5, 0.0)))


def _mesh(surface: Surface) -> Mesh:
    """Without looks, as the simulator has it."""
    none = np.zeros((len(surface.vertices), 3), np.float32)
    return Mesh(surface.vertices.astype(np.float32), none, none[:, :2], surface.triangles.astype(np.uint32))


def _unique(name: str, taken: set[str]) -> str:
    found, k = name[:70], 1
    while found in taken:
        k += 1
        found = f"{name[:70]}-{k}"
    taken.add(found)
    return found


def _slug(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name).strip("._")[:60] or "model"
