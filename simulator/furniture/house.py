"""A village house from outside: plinth, plaster, gabled roof, chimney, windows with shutters, a door."""

import numpy as np

from simulator.scene.faces import face
from simulator.scene.parts import Material, Part, Piece, Rgb, Vec3
from simulator.scene.shapes import around, box, detail, label

PLINTH_M, OVERHANG_M = 0.35, 0.45
GLASS = Material("view", (70, 84, 98), 7)
FRAME = Material("lacquer", (238, 236, 230), 3)
STONE = Material("concrete", (150, 146, 138), 7)
"""Windows of all houses are alike, as in the thesis's village."""


def house(
    rng: np.random.Generator,
    width_m: float = 9.0,
    depth_m: float = 7.5,
    eaves_m: float = 3.0,
    ridge_m: float = 5.6,
    walls: Rgb = (226, 214, 190),
    roof: Rgb = (150, 74, 54),
    shutters: Rgb = (72, 104, 82),
) -> Piece:
    """House with its front along +x; the ridge runs along y."""
    del rng
    plaster, wood = Material("plaster", walls, 4), Material("planks", shutters, 2)
    w, d = width_m / 2, depth_m / 2
    parts: list[Part] = [
        box((-d, d), (-w, w), (PLINTH_M, eaves_m), plaster, tile_m=3.0),
        box((-d - 0.05, d + 0.05), (-w - 0.05, w + 0.05), (0.0, PLINTH_M), STONE, tile_m=1.5),
        *_gables(d, w, eaves_m, ridge_m, plaster),
        *_roof(d, w, eaves_m, ridge_m, Material("roof_tiles", roof, 5)),
        *_chimney(d, w, ridge_m),
    ]
    for side, places in ((1.0, (-0.62, 0.3, 0.72)), (-1.0, (-0.6, 0.0, 0.6))):
        for share in places:
            parts += _window(side * d, share * w, wood, side)
    parts += _door(d, -0.18 * w, wood)
    for side in (1.0, -1.0):
        for share in (-0.45, 0.45):
            parts += _gable_window(share * d, side * w, side)
    return Piece.of(*parts)


def _window(x: float, y: float, shutter: Material, out: float) -> list[Part]:
    """Glass in a white frame with a cross, a sill, and open shutters."""
    z, half = (1.05, 2.25), 0.5
    parts = [
        label((x, x + 0.03 * out), around(y, half), z, GLASS),
        detail((x, x + 0.14 * out), (y - half - 0.1, y + half + 0.1), (z[0] - 0.08, z[0]), STONE),
    ]
    for at in (-half, 0.0, half):
        parts.append(detail((x, x + 0.06 * out), around(y + at, 0.035), z, FRAME))
    for at in (z[0] + 0.03, 1.65, z[1] - 0.03):
        parts.append(detail((x, x + 0.06 * out), around(y, half), around(at, 0.03), FRAME))
    for sign in (-1.0, 1.0):
        inner, outer = y + sign * (half + 0.04), y + sign * (half + 0.5)
        span = (min(inner, outer), max(inner, outer))
        parts.append(detail((x, x + 0.05 * out), span, z, shutter, tile_m=0.6))
    return parts


def _gable_window(x: float, y: float, out: float) -> list[Part]:
    z, half = (1.1, 2.2), 0.4
    return [
        label(around(x, half), (y, y + 0.03 * out), z, GLASS),
        detail(around(x, 0.03), (y, y + 0.06 * out), z, FRAME),
        *(detail(around(x, half), (y, y + 0.06 * out), around(at, 0.04), FRAME) for at in z),
    ]


def _door(x: float, y: float, wood: Material) -> list[Part]:
    """Panelled door under a small canopy, with a step in front."""
    return [
        detail((x, x + 0.06), around(y, 0.5), (0.2, 2.3), wood, tile_m=1.0),
        detail((x, x + 0.1), (y - 0.58, y - 0.5), (0.2, 2.38), FRAME),
        detail((x, x + 0.1), (y + 0.5, y + 0.58), (0.2, 2.38), FRAME),
        detail((x, x + 0.9), around(y, 0.9), (2.5, 2.6), Material("planks", (110, 84, 60), 4)),
        box((x + 0.05, x + 0.9), around(y, 0.8), (0.0, 0.2), STONE, tile_m=1.0),
    ]


def _chimney(d: float, w: float, ridge_m: float) -> list[Part]:
    brick = Material("bricks", (146, 80, 62), 6)
    x, y = -0.3 * d, 0.5 * w
    return [
        detail(around(x, 0.3), around(y, 0.3), (ridge_m - 1.2, ridge_m + 0.7), brick, tile_m=1.2),
        detail(around(x, 0.36), around(y, 0.36), (ridge_m + 0.7, ridge_m + 0.8), STONE),
    ]


def _gables(d: float, w: float, eaves_m: float, ridge_m: float, plaster: Material) -> list[Part]:
    """The triangles of wall below both ends of the ridge."""
    profile = ((-d, eaves_m), (d, eaves_m), (0.0, ridge_m - 0.1))
    return [face([(x, y, z) for x, z in profile], (0.0, y, 0.0), plaster, 3.0) for y in (-w, w)]


def _roof(d: float, w: float, eaves_m: float, ridge_m: float, tiles: Material) -> list[Part]:
    """Two slopes that overhang, with visible undersides."""
    slope = (ridge_m - eaves_m) / d
    low, reach, side = eaves_m - OVERHANG_M * slope, d + OVERHANG_M, w + OVERHANG_M
    parts = []
    for out in (1.0, -1.0):
        corners: list[Vec3] = [
            (out * reach, -side, low),
            (out * reach, side, low),
            (0.0, side, ridge_m),
            (0.0, -side, ridge_m),
        ]
        parts.append(face(corners, (out, 0.0, 1.0), tiles, 1.6))
        under: list[Vec3] = [(x, y, z - 0.08) for x, y, z in corners]
        parts.append(face(under, (-out, 0.0, -1.0), Material("planks", (120, 92, 66), 4), 1.2))
    return parts
