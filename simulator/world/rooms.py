"""Rooms and openings of a world file -> floors, ceilings, walls, lintels and skirting boards. Pure.

Long surfaces are cut into panels of different texture: one that repeats along a wall makes spots look alike
at multiples of its period, and real walls do not.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from simulator.scene.parts import Material, Part
from simulator.scene.shapes import box
from simulator.world.world_file import Opening, Room, Surface, WorldFile

SKIRTING = Material("lacquer", (236, 234, 228), 5)
SKIRTING_HEIGHT_M = 0.08
SKIRTING_DEPTH_M = 0.012
FLOOR_DEPTH_M = 0.1
CONTACT_M = 1e-6
YARD_M, YARD_GRAIN_M = 12.0, 0.45  # grounds larger than this, where few things are looked at closely
Span = tuple[float, float]
Rect = tuple[Span, Span]


def room_parts(world: WorldFile) -> list[Part]:
    """All parts of the building, world frame."""
    parts: list[Part] = []
    for room in world.rooms:
        height = room.height_m or world.wall_height_m
        parts.extend(floor_parts((room.x_m, room.y_m), room.floor))
        parts.append(
            box(
                room.x_m,
                room.y_m,
                (height, height + 0.1),
                _material(room.ceiling),
                solid=False,
                tile_m=room.ceiling.tile_m,
                casts_shadow=bool(world.grounds),
            )
        )
        for side in range(4):
            parts.extend(_side(world, room, side, height))
    for opening in world.openings:
        parts.extend(floor_parts((opening.x_m, opening.y_m), opening.floor))
    return parts


def _material(surface: Surface) -> Material:
    return Material(surface.texture, surface.colour, surface.seed)


def floor_parts(rect: Rect, surface: Surface) -> list[Part]:
    """The slabs under a piece of floor; their top is at height 0."""
    whole = surface.variants == 1
    yard = max(high - low for low, high in rect) > YARD_M
    return [
        box(
            x,
            y,
            (-FLOOR_DEPTH_M, 0.0),
            _panel_material(_material(surface), surface, x[0], y[0]),
            solid=False,
            tile_m=surface.tile_m,
            casts_shadow=False,
            grain_m=YARD_GRAIN_M if yard else None,
        )
        for x in ([rect[0]] if whole else cut(rect[0], surface.tile_m))
        for y in ([rect[1]] if whole else cut(rect[1], surface.tile_m))
    ]


def _panel_material(material: Material, surface: Surface, *where: float) -> Material:
    return replace(material, seed=material.seed + variant(surface.variants, *where))


def _side(world: WorldFile, room: Room, side: int, height: float) -> list[Part]:
    """Wall along one side (0 west, 1 east, 2 south, 3 north), cut where openings and other rooms touch it."""
    normal_axis, outward = side // 2, (-1.0, 1.0)[side % 2]
    spans: Rect = (room.x_m, room.y_m)
    line, along = spans[normal_axis][side % 2], spans[1 - normal_axis]
    outer = line + outward * world.wall_thickness_m
    material, tile = _material(room.walls), room.walls.tile_m
    cuts: list[tuple[Span, float]] = []
    neighbours: list[Room | Opening] = [*world.openings, *(r for r in world.rooms if r is not room)]
    for other in neighbours:
        rect: Rect = (other.x_m, other.y_m)
        touches = min(abs(edge - line) for edge in rect[normal_axis]) < CONTACT_M
        if touches and _overlap(rect[1 - normal_axis], along):
            cuts.append((rect[1 - normal_axis], other.height_m if isinstance(other, Opening) else height))
    parts: list[Part] = []
    for span in _remaining(
        along, [c for c, _ in cuts], _reach(world, normal_axis, (line + outer) / 2, along)
    ):
        for piece in [span] if room.walls.variants == 1 else cut(span, tile):
            look = _panel_material(material, room.walls, side, line, piece[0])
            parts.append(_slab(normal_axis, (line, outer), piece, (0.0, height), look, tile))
        inner = line - outward * SKIRTING_DEPTH_M
        clipped = (max(span[0], along[0]), min(span[1], along[1]))
        if clipped[0] < clipped[1]:
            parts.append(
                _slab(
                    normal_axis, (line, inner), clipped, (0.0, SKIRTING_HEIGHT_M), SKIRTING, 0.8, solid=False
                )
            )
    for span, top in cuts:
        if top < height:
            parts.append(_slab(normal_axis, (line, outer), span, (top, height), material, tile))
    return parts


def _slab(
    axis: int, across: Span, along: Span, z: Span, material: Material, tile: float, solid: bool = True
) -> Part:
    x, y = (across, along) if axis == 0 else (along, across)
    return box(x, y, z, material, tile_m=tile, solid=solid)


def _overlap(a: Span, b: Span) -> bool:
    return min(a[1], b[1]) - max(a[0], b[0]) > CONTACT_M


def _reach(world: WorldFile, axis: int, across: float, along: Span) -> Span:
    """Ends of a wall: it goes on round the corner by its thickness unless it would enter a room."""
    t = world.wall_thickness_m

    def free(at: float) -> bool:
        x, y = (across, at) if axis == 0 else (at, across)
        return not world.holds(x, y)

    low = along[0] - (t if free(along[0] - t / 2) else 0.0)
    return low, along[1] + (t if free(along[1] + t / 2) else 0.0)


def _remaining(along: Span, cuts: list[Span], reach: Span) -> list[Span]:
    """What is left of a wall after the cuts; uncut ends go as far as `reach`."""
    spans, start = [], reach[0]
    for low, high in sorted(cuts):
        if low - start > CONTACT_M and low > along[0] + CONTACT_M:
            spans.append((start, low))
        start = max(start, high)
    if along[1] - start > CONTACT_M:
        spans.append((start, reach[1]))
    return spans


def cut(span: Span, tile_m: float) -> list[Span]:
    """Cut at multiples of the tile, where textures meet; less than half a tile stays with its neighbour."""
    low, high = span
    first, last = math.ceil(low / tile_m), math.floor(high / tile_m)
    inner = [k * tile_m for k in range(first, last + 1)]
    inner = [at for at in inner if at - low > tile_m / 2 and high - at > tile_m / 2]
    ends = [low, *inner, high]
    return list(pairwise(ends))


def variant(count: int, *where: float) -> int:
    """Which of `count` textures a panel shows: irregular, but always the same at the same place."""
    if count <= 1:
        return 0
    cells = [round(10 * at) & 0xFFFF_FFFF for at in where]
    return int(np.random.default_rng([count, *cells]).integers(count))
