"""Office furniture: swivel chair, round table, whiteboard, notice board, lockers, copier, recycling bins."""

import numpy as np

from simulator.furniture.stacks import any_colour, shade_of
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, box, detail, label, post, rounded
from simulator.textures.noise import one_of

STEEL = Material("metal", (176, 178, 182), 4)
DARK = Material("lacquer", (44, 46, 50), 3)
WHITE = Material("lacquer", (238, 238, 234), 6)


def office_chair(rng: np.random.Generator, colour: Rgb = (52, 78, 116)) -> Piece:
    """Swivel chair that faces +x, on a foot with five arms."""
    cloth = Material("fabric", colour, int(rng.integers(3)))
    parts: list[Part] = [
        post(0.0, 0.0, (0.0, 0.09), 0.27, DARK, taper=0.4),
        post(0.0, 0.0, (0.09, 0.42), 0.035, STEEL),
        box((-0.22, 0.22), (-0.23, 0.23), (0.4, 0.44), DARK),
        rounded((0.0, 0.0, 0.48), (0.46, 0.47, 0.1), cloth, solid=False, tile_m=0.5),
        rounded((-0.24, 0.0, 0.82), (0.08, 0.44, 0.5), cloth, solid=False, tile_m=0.5),
        detail((-0.26, -0.22), (-0.03, 0.03), (0.42, 0.7), DARK),
    ]
    return Piece.of(*parts)


def round_table(
    rng: np.random.Generator, radius_m: float = 0.45, height_m: float = 0.74, colour: Rgb = (206, 186, 152)
) -> Piece:
    """Table on a column, with a few cups and a magazine."""
    top = Material("wood", colour, int(rng.integers(3)))
    parts: list[Part] = [
        post(0.0, 0.0, (0.0, 0.03), 0.27, STEEL),
        post(0.0, 0.0, (0.03, height_m - 0.03), 0.04, STEEL),
        post(0.0, 0.0, (height_m - 0.03, height_m), radius_m, top, tile_m=0.9),
    ]
    for _ in range(4):
        angle, out = float(rng.uniform(0, 2 * np.pi)), radius_m * float(rng.uniform(0.2, 0.7))
        ink = any_colour(rng, 40, 230)
        place = (out * float(np.cos(angle)), out * float(np.sin(angle)))
        mug = Material("ceramic", ink, 2)
        parts.append(post(*place, (height_m, height_m + 0.09), 0.035, mug, solid=False, tile_m=0.3))
    sheet = Material("poster", (230, 230, 220), int(rng.integers(9)))
    parts.append(label((-0.14, 0.08), (-0.1, 0.06), (height_m, height_m + 0.006), sheet))
    return Piece.of(*parts)


def whiteboard(rng: np.random.Generator, width_m: float = 1.8, height_m: float = 1.1) -> Piece:
    """Board on the wall with lines of writing; the item's height is its centre."""
    y, z = width_m / 2, height_m / 2
    parts: list[Part] = [
        detail((0.0, 0.02), (-y, y), (-z, z), WHITE, tile_m=1.5),
        detail((0.0, 0.07), (-y, y), (-z - 0.04, -z), STEEL),
    ]
    inks: tuple[Rgb, ...] = ((32, 64, 160), (176, 30, 34), (24, 110, 60), (30, 30, 34))
    for row in range(9):
        at = z - 0.1 - row * height_m / 10
        start = -y + 0.1
        while start < y - 0.3:
            end = start + float(rng.uniform(0.05, 0.22))
            ink = Material("lacquer", inks[int(rng.integers(4))], 1)
            thick = float(rng.uniform(0.012, 0.03))
            parts.append(detail((0.02, 0.022), (start, min(end, y - 0.1)), (at, at + thick), ink))
            start = end + float(rng.uniform(0.03, 0.14))
    return Piece.of(*parts)


def notice_board(rng: np.random.Generator, width_m: float = 1.4, height_m: float = 1.0) -> Piece:
    """Cork with papers pinned on it; the item's height is its centre."""
    y, z = width_m / 2, height_m / 2
    parts: list[Part] = [
        detail((0.0, 0.02), (-y, y), (-z, z), Material("bark", (188, 146, 98), 4), tile_m=0.8),
        detail((0.0, 0.03), (-y - 0.03, -y), (-z, z), Material("wood", (120, 84, 54), 1)),
        detail((0.0, 0.03), (y, y + 0.03), (-z, z), Material("wood", (120, 84, 54), 1)),
    ]
    for k in range(12):
        w, h = float(rng.uniform(0.14, 0.26)), float(rng.uniform(0.18, 0.3))
        left, low = float(rng.uniform(-y, y - w)), float(rng.uniform(-z, z - h))
        kind = one_of(rng, ("poster", "panel", "street", "abstract"))
        front = 0.022 + 0.0015 * k
        paper = Material(kind, (236, 232, 216), int(rng.integers(40)))
        parts.append(label((0.02, front), (left, left + w), (low, low + h), paper))
    return Piece.of(*parts)


def lockers(rng: np.random.Generator, columns: int = 4, colour: Rgb = (118, 138, 142)) -> Piece:
    """Rows of lockers against the wall, two high, some with stickers."""
    parts: list[Part] = []
    half = 0.2 * columns
    parts.append(box((0.0, 0.46), (-half, half), (0.0, 1.8), Material("lacquer", colour, 7), tile_m=1.4))
    for k in range(columns):
        for row in range(2):
            y, z = -half + 0.4 * k, 0.05 + 0.88 * row
            tone = shade_of(rng, colour, 8)
            parts += [
                detail((0.46, 0.475), (y + 0.015, y + 0.385), (z, z + 0.84), Material("lacquer", tone, 2)),
                detail((0.475, 0.5), (y + 0.32, y + 0.35), (z + 0.4, z + 0.5), STEEL),
            ]
            if rng.random() < 0.6:
                sticker = Material("abstract", (220, 200, 60), int(rng.integers(30)))
                at = z + float(rng.uniform(0.15, 0.6))
                parts.append(label((0.475, 0.478), (y + 0.08, y + 0.22), (at, at + 0.14), sticker))
    return Piece.of(*parts)


def copier(rng: np.random.Generator) -> Piece:
    """Copying machine on the floor with drawers, a panel and paper; back against x = 0."""
    del rng
    body = Material("lacquer", (206, 208, 206), 8)
    parts: list[Part] = [
        box((0.0, 0.6), (-0.3, 0.3), (0.03, 0.95), body, tile_m=0.9),
        detail((0.05, 0.55), (-0.28, 0.28), (0.95, 1.08), Material("lacquer", (70, 74, 78), 4)),
        detail((0.6, 0.605), (-0.28, 0.28), (0.1, 0.32), WHITE),
        detail((0.6, 0.605), (-0.28, 0.28), (0.34, 0.56), WHITE),
        label((0.56, 0.66), (-0.26, 0.0), (0.96, 1.0), Material("panel", (84, 90, 96), 11)),
    ]
    return Piece.of(*parts)


def recycling_bins(rng: np.random.Generator) -> Piece:
    """Three bins in a row for paper, glass and the rest."""
    parts: list[Part] = []
    for k, ink in enumerate(((44, 92, 160), (60, 120, 66), (96, 96, 98))):
        y = 0.42 * (k - 1)
        parts += [
            box((-0.18, 0.18), around(y, 0.18), (0.0, 0.72), Material("lacquer", ink, 5), tile_m=0.6),
            detail((-0.19, 0.19), around(y, 0.19), (0.72, 0.78), DARK),
        ]
        sign = Material("panel" if k else "poster", (240, 240, 236), int(rng.integers(9)))
        parts.append(label((0.18, 0.184), around(y, 0.09), (0.36, 0.54), sign))
    return Piece.of(*parts)
