"""Surfaces in heaps that each fit a model file of ours; a mesh that is larger is cut on its length. Pure."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from simulator.importing.meshes.surfaces import IntArray, Surface

MOST_TRIANGLES = 100_000  # half of what a model file may have, as normals part vertices
MOST_TEXELS = 12_000_000  # three pictures of 2048 x 2048: 36 MB at most, of the 64 that a file may have


def heaps(surfaces: Sequence[Surface]) -> list[list[Surface]]:
    """All surfaces in as few heaps as their order allows; one heap where all of them fit."""
    found: list[list[Surface]] = []
    triangles = texels = 0
    pictures: set[int] = set()
    for surface in (piece for whole in surfaces for piece in _pieces(whole)):
        picture = surface.look.picture
        fresh = 0 if picture is None or id(picture) in pictures else picture.shape[0] * picture.shape[1]
        full = triangles + len(surface.triangles) > MOST_TRIANGLES or texels + fresh > MOST_TEXELS
        if not found or full:
            found.append([])
            triangles, texels, pictures = 0, 0, set()
            fresh = 0 if picture is None else picture.shape[0] * picture.shape[1]
        found[-1].append(surface)
        triangles, texels = triangles + len(surface.triangles), texels + fresh
        pictures |= set() if picture is None else {id(picture)}
    return found


def _pieces(surface: Surface) -> list[Surface]:
    """A surface in halves of its longer level side, and these again, until all have few enough triangles."""
    if len(surface.triangles) <= MOST_TRIANGLES:
        return [surface]
    middles = surface.vertices[surface.triangles].mean(axis=1)
    axis = int(np.argmax(np.ptp(middles[:, :2], axis=0)))
    order = np.argsort(middles[:, axis], kind="stable")
    half = len(order) // 2
    return [piece for part in (order[:half], order[half:]) for piece in _pieces(_only(surface, part))]


def _only(surface: Surface, chosen: IntArray) -> Surface:
    """Some triangles of a surface, with the vertices that they need."""
    used, back = np.unique(surface.triangles[chosen], return_inverse=True)
    return replace(
        surface,
        vertices=surface.vertices[used],
        triangles=back.reshape(-1, 3).astype(np.int64),
        uvs=None if surface.uvs is None else surface.uvs[used],
        colours=None if surface.colours is None else surface.colours[used],
    )
