"""Grounds of a world file -> floors and the borders that nobody crosses. Pure."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from simulator.scene.parts import Material, Part
from simulator.scene.shapes import around, box
from simulator.world.rooms import cut, floor_parts, variant
from simulator.world.world_file import Ground, Room, WorldFile

CONTACT_M = 1e-6
POST_EVERY_M = 2.0
PICKET_EVERY_M = 0.32
TILE_M = 1.6
"""Length of a bar after which its texture repeats."""
PANELS, BLOCKS = 12, 6
"""Looks of walls' panels and of barriers' blocks; chosen: a panel has equals, 20 m away and among others."""
Span = tuple[float, float]
Edge = tuple[int, float, float]
"""Axis of the normal, place of the edge on it, and +1 or -1 towards the outside."""

WOOD = Material("planks", (148, 112, 78), 3)
CONCRETE = Material("concrete", (176, 174, 168), 2)
KERB = Material("concrete", (192, 190, 186), 5)
PAVING = Material("paving", (168, 160, 150), 4)
BRICK = Material("bricks", (150, 86, 66), 6)


def ground_parts(world: WorldFile) -> list[Part]:
    """Floors of all grounds and their borders, world frame."""
    parts: list[Part] = []
    for ground in world.grounds:
        if ground.floor is not None:
            parts.extend(floor_parts((ground.x_m, ground.y_m), ground.floor))
        if ground.border != "none":
            build = BORDERS[ground.border]
            for edge, span in _outer_edges(world, ground):
                parts.extend(build(edge, span))
    return parts


def _outer_edges(world: WorldFile, ground: Ground) -> list[tuple[Edge, Span]]:
    """The pieces of the four edges that touch neither another floor nor the wall of a room."""
    others = [r for r in world.rectangles() if r != (ground.x_m, ground.y_m)]
    others += [_with_walls(room, world.wall_thickness_m) for room in world.rooms]
    found: list[tuple[Edge, Span]] = []
    spans = (ground.x_m, ground.y_m)
    for axis in (0, 1):
        for end, outward in ((0, -1.0), (1, 1.0)):
            line, along = spans[axis][end], spans[1 - axis]
            touching = [
                r[1 - axis] for r in others if r[axis][0] - CONTACT_M <= line <= r[axis][1] + CONTACT_M
            ]
            found += [((axis, line, outward), piece) for piece in _without(along, touching)]
    return found


def _with_walls(room: Room, wall_m: float) -> tuple[Span, Span]:
    (west, east), (south, north) = room.x_m, room.y_m
    return (west - wall_m, east + wall_m), (south - wall_m, north + wall_m)


def _without(along: Span, cuts: list[Span]) -> list[Span]:
    pieces, start = [], along[0]
    for low, high in sorted(cuts):
        if low - start > CONTACT_M:
            pieces.append((start, min(low, along[1])))
        start = max(start, high)
    if along[1] - start > CONTACT_M:
        pieces.append((start, along[1]))
    return [piece for piece in pieces if piece[1] - piece[0] > CONTACT_M]


def _bar(edge: Edge, span: Span, depth: Span, z: Span, material: Material, solid: bool = True) -> Part:
    """A box along an edge, from `depth[0]` to `depth[1]` outwards of it."""
    axis, line, outward = edge
    across = (line + outward * depth[0], line + outward * depth[1])
    x, y = (across, span) if axis == 0 else (span, across)
    return box(x, y, z, material, solid=solid, tile_m=TILE_M)


def _panelled(edge: Edge, span: Span, depth: Span, z: Span, material: Material) -> list[Part]:
    """A long bar in panels that differ, each as long as its texture: a longer one would show it twice."""
    parts, last = [], -1
    for piece in cut(span, TILE_M):
        look = variant(PANELS, edge[0], edge[1], piece[0])
        look = (look + 1) % PANELS if look == last else look
        parts.append(_bar(edge, piece, depth, z, replace(material, seed=material.seed + look)))
        last = look
    return parts


def _fence(edge: Edge, span: Span) -> list[Part]:
    """Pickets on two rails between posts; one solid rail at the bottom keeps the robot in."""
    length = span[1] - span[0]
    posts = np.linspace(span[0], span[1], max(2, round(length / POST_EVERY_M) + 1))
    pickets = np.arange(span[0] + PICKET_EVERY_M / 2, span[1], PICKET_EVERY_M)
    parts = [_bar(edge, span, (0.02, 0.1), (0.05, 0.45), WOOD)]
    parts.append(_bar(edge, span, (0.03, 0.07), (0.86, 0.95), WOOD, solid=False))
    parts += [_bar(edge, around(p, 0.05), (0.0, 0.1), (0.0, 1.25), WOOD, solid=False) for p in posts]
    tops = 1.08 + 0.06 * np.cos(pickets * 3.1)
    parts += [
        _bar(edge, around(p, 0.06), (0.0, 0.03), (0.05, float(top)), WOOD, solid=False)
        for p, top in zip(pickets, tops, strict=True)
    ]
    return parts


def _barrier(edge: Edge, span: Span) -> list[Part]:
    """Concrete blocks with a wide foot and a narrow top."""
    count = max(1, round((span[1] - span[0]) / 3.0))
    ends = np.linspace(span[0], span[1], count + 1)
    parts = []
    for low, high in pairwise(ends):
        piece = (float(low) + 0.02, float(high) - 0.02)
        look = replace(CONCRETE, seed=CONCRETE.seed + variant(BLOCKS, edge[0], edge[1], low))
        parts.append(_bar(edge, (float(low), float(high)), (0.0, 0.5), (0.0, 0.3), look))
        parts.append(_bar(edge, piece, (0.12, 0.38), (0.3, 0.82), look))
    return parts


def _sidewalk(edge: Edge, span: Span) -> list[Part]:
    """A kerb too high for the robot, and the pavement behind it."""
    return [
        *_panelled(edge, span, (0.0, 0.18), (0.0, 0.14), KERB),
        *_panelled(edge, span, (0.18, 2.2), (0.0, 0.13), PAVING),
    ]


def _wall(edge: Edge, span: Span) -> list[Part]:
    """Bricks under a coping of stone."""
    return [
        *_panelled(edge, span, (0.0, 0.24), (0.0, 2.1), BRICK),
        _bar(edge, span, (-0.03, 0.27), (2.1, 2.2), CONCRETE, solid=False),
    ]


BORDERS: dict[str, Callable[[Edge, Span], list[Part]]] = {
    "fence": _fence,
    "barrier": _barrier,
    "sidewalk": _sidewalk,
    "wall": _wall,
}
