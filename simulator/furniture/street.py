"""Street furniture: lights, bus stop, bench, bin, mailbox, fountain."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, ball, box, detail, label, post

STEEL = Material("metal", (92, 98, 104), 2)
DARK = Material("metal", (52, 58, 62), 3)
STONE = Material("concrete", (184, 178, 166), 11)


def street_light(rng: np.random.Generator, height_m: float = 4.2) -> Piece:
    """A post on a foot with an arm and a lantern."""
    del rng
    glow = Material("glow", (250, 244, 226), 1, 1.0)
    return Piece.of(
        post(0.0, 0.0, (0.0, 0.5), 0.11, DARK, taper=0.7),
        post(0.0, 0.0, (0.5, height_m), 0.05, DARK, taper=0.8, solid=False),
        detail((0.0, 0.9), (-0.03, 0.03), (height_m - 0.06, height_m), DARK),
        detail((0.62, 1.0), (-0.12, 0.12), (height_m - 0.2, height_m - 0.04), STEEL),
        detail((0.66, 0.96), (-0.09, 0.09), (height_m - 0.24, height_m - 0.2), glow),
    )


def bus_stop(rng: np.random.Generator, length_m: float = 3.4, poster: int = 1) -> Piece:
    """Shelter open to +x: roof on posts, back wall with a poster and a timetable, a seat, a flag."""
    del rng
    y, depth = length_m / 2, 1.3
    glass, flag = Material("panel", (150, 170, 176), 4), Material("lacquer", (232, 186, 36), 4)
    parts: list[Part] = [
        box((-0.06, 0.0), (-y, y), (0.15, 2.2), glass, tile_m=1.1),
        detail((-0.12, depth), (-y - 0.1, y + 0.1), (2.25, 2.37), Material("lacquer", (38, 84, 132), 2)),
        box((0.15, 0.55), (-y + 0.4, y - 0.9), (0.42, 0.5), Material("planks", (150, 112, 74), 6)),
        box((0.25, 0.45), (-y + 0.5, -y + 0.6), (0.0, 0.42), STEEL),
        box((0.25, 0.45), (y - 1.1, y - 1.0), (0.0, 0.42), STEEL),
        label((0.0, 0.03), (y - 0.85, y - 0.1), (0.7, 1.9), Material("poster", (200, 60, 60), poster)),
        label((0.0, 0.03), (-0.3, 0.3), (1.1, 1.8), Material("panel", (240, 240, 236), 9)),
    ]
    parts += [
        post(x, side * y, (0.0, 2.25), 0.045, STEEL) for x in (0.0, depth - 0.1) for side in (-1.0, 1.0)
    ]
    parts += [
        post(depth + 0.2, y + 0.9, (0.0, 2.7), 0.04, STEEL),
        detail((depth + 0.17, depth + 0.23), (y + 0.62, y + 1.18), (2.2, 2.75), flag),
    ]
    return Piece.of(*parts)


def park_bench(rng: np.random.Generator, length_m: float = 1.7) -> Piece:
    """Slatted bench that faces +x."""
    del rng
    wood = Material("planks", (142, 96, 60), 5)
    y = length_m / 2
    parts: list[Part] = [
        box((-0.25, 0.25), around(s * y * 0.8, 0.04), (0.0, 0.42), DARK) for s in (-1.0, 1.0)
    ]
    parts += [box((x, x + 0.12), (-y, y), (0.42, 0.46), wood, tile_m=0.9) for x in (-0.2, -0.05, 0.1)]
    parts += [detail((-0.3, -0.26), (-y, y), (z, z + 0.1), wood, tile_m=0.9) for z in (0.58, 0.74)]
    return Piece.of(*parts)


def litter_bin(rng: np.random.Generator, colour: Rgb = (62, 96, 66)) -> Piece:
    """A bin on a post with a lid."""
    del rng
    return Piece.of(
        post(0.0, 0.0, (0.0, 0.85), 0.21, Material("metal", colour, 4), taper=1.1, tile_m=0.5),
        post(0.0, 0.0, (0.85, 0.93), 0.24, DARK, taper=0.5, solid=False),
    )


def mailbox(rng: np.random.Generator, colour: Rgb = (226, 178, 32)) -> Piece:
    """A letter box on a post, slot towards +x."""
    del rng
    ink = Material("lacquer", colour, 3)
    return Piece.of(
        post(0.0, 0.0, (0.0, 0.85), 0.06, DARK),
        box((-0.16, 0.16), (-0.22, 0.22), (0.8, 1.4), ink, tile_m=0.6),
        detail((0.16, 0.175), (-0.15, 0.15), (1.2, 1.25), DARK),
        label((0.16, 0.17), (-0.12, 0.12), (0.9, 1.1), Material("panel", (240, 240, 236), 3)),
    )


def fountain(rng: np.random.Generator, radius_m: float = 1.9) -> Piece:
    """Round basin with water, a column and a bowl that spills."""
    water = Material("view", (92, 132, 150), int(rng.integers(3)))
    r = radius_m
    parts: list[Part] = [
        post(0.0, 0.0, (0.0, 0.16), r + 0.35, STONE, tile_m=1.2),
        post(0.0, 0.0, (0.16, 0.62), r, Material("bricks", (168, 156, 138), 3), tile_m=1.5),
        post(0.0, 0.0, (0.62, 0.7), r + 0.08, STONE, tile_m=1.2),
        post(0.0, 0.0, (0.7, 0.71), r - 0.2, water, solid=False, tile_m=1.5),
        post(0.0, 0.0, (0.6, 1.5), 0.24, STONE, taper=0.8, tile_m=0.8),
        post(0.0, 0.0, (1.5, 1.72), 0.5, STONE, taper=1.7, tile_m=0.9, solid=False),
        post(0.0, 0.0, (1.72, 2.1), 0.12, STONE, taper=0.7, tile_m=0.5, solid=False),
        ball((0.0, 0.0, 2.2), (0.32, 0.32, 0.36), STONE, tile_m=0.5),
    ]
    return Piece.of(*parts)
