"""What stands in a hall: narrow table, shoe cabinet, coat rack, basket."""

from itertools import pairwise

import numpy as np

from simulator.furniture.stacks import book_pile, framed, ornament
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, ball, box, detail, post, rounded
from simulator.textures.noise import one_of


def console_table(
    rng: np.random.Generator,
    width_m: float = 1.0,
    depth_m: float = 0.3,
    height_m: float = 0.79,
    colour: Rgb = (108, 74, 48),
) -> Piece:
    """Table with one drawer, a lower shelf and things on both; back at x = 0."""
    wood, steel = Material("wood", colour, int(rng.integers(3))), Material("metal", (190, 186, 178), 2)
    half = width_m / 2
    parts = [
        box((0.0, depth_m), (-half, half), (height_m - 0.03, height_m), wood, tile_m=0.7),
        box((0.02, depth_m - 0.02), (-half + 0.02, half - 0.02), (height_m - 0.15, height_m - 0.03), wood),
        box((0.02, depth_m - 0.02), (-half + 0.02, half - 0.02), (0.16, 0.185), wood),
        detail((depth_m - 0.02, depth_m - 0.01), (-0.04, 0.04), (height_m - 0.1, height_m - 0.08), steel),
    ]
    parts.extend(
        box((x, x + 0.035), (y, y + 0.035), (0.0, height_m - 0.03), wood)
        for x in (0.01, depth_m - 0.045)
        for y in (-half + 0.01, half - 0.045)
    )
    basket = Material("wicker", (170, 134, 88), int(rng.integers(3)))
    parts.append(detail((0.04, depth_m - 0.04), (-half + 0.1, -0.05), (0.185, 0.42), basket, tile_m=0.3))
    parts += book_pile(rng, (depth_m / 2, half - 0.28, 0.185), 6)
    parts += ornament(rng, (depth_m / 2, -half + 0.17, height_m))
    parts += framed(rng, (depth_m / 2, 0.02, height_m))
    parts += book_pile(rng, (depth_m / 2, half - 0.22, height_m), 3)
    return Piece.of(*parts)


def shoe_cabinet(
    rng: np.random.Generator,
    width_m: float = 1.0,
    depth_m: float = 0.22,
    height_m: float = 0.95,
    colour: Rgb = (206, 198, 184),
) -> Piece:
    """Cabinet with its back at x = 0."""
    paint, knob = Material("lacquer", colour, int(rng.integers(100))), Material("wood", (120, 84, 54), 3)
    half, top = width_m / 2, Material("wood", (166, 122, 80), 8)
    parts = [
        box((0.0, depth_m - 0.02), (-half, half), (0.05, height_m - 0.02), paint, tile_m=0.6),
        box((0.0, depth_m + 0.01), (-half - 0.01, half + 0.01), (height_m - 0.02, height_m), top),
        box((0.02, depth_m - 0.04), (-half + 0.02, half - 0.02), (0.0, 0.05), paint),
    ]
    for low, high in pairwise(np.linspace(0.06, height_m - 0.03, 4).tolist()):
        for y in ((-half, -0.004), (0.004, half)):
            parts.append(box((depth_m - 0.02, depth_m), y, (low + 0.004, high - 0.004), paint, tile_m=0.5))
            grip = around((y[0] + y[1]) / 2, 0.05)
            parts.append(detail((depth_m, depth_m + 0.02), grip, (high - 0.06, high - 0.045), knob))
    parts += ornament(rng, (depth_m / 2, -half + 0.2, height_m))
    parts += framed(rng, (depth_m / 2, 0.1, height_m))
    parts += ornament(rng, (depth_m / 2, half - 0.2, height_m))
    return Piece.of(*parts)


COATS: tuple[Rgb, ...] = ((66, 74, 92), (150, 112, 70), (118, 40, 46), (84, 98, 72), (190, 184, 172))


def coat_rack(
    rng: np.random.Generator, width_m: float = 1.0, coats: int = 4, colour: Rgb = (124, 88, 56)
) -> Piece:
    """Board with hooks on a wall at x = 0; the item's height is that of the board."""
    wood = Material("wood", colour, int(rng.integers(3)))
    half = width_m / 2
    parts = [
        box((0.0, 0.025), (-half, half), (-0.06, 0.06), wood),
        box((0.0, 0.22), (-half, half), (0.12, 0.14), wood),
    ]
    steel = Material("metal", (150, 150, 154), 3)
    for k in range(coats):
        y = -half + (k + 0.5) * width_m / coats
        parts.append(detail((0.02, 0.08), around(y, 0.01), (-0.02, 0.0), steel))
        cloth = Material("fabric", one_of(rng, COATS), int(rng.integers(3)))
        long, wide = float(rng.uniform(0.55, 0.75)), width_m / coats
        parts += [
            Part(
                "drape", (0.08, y, -0.02 - long / 2), (0.1, wide * 0.8, long), cloth, solid=False, tile_m=0.5
            ),
            rounded((0.07, y, -0.12), (0.1, wide * 0.75, 0.2), cloth, solid=False, tile_m=0.5),
        ]
    for y in (-half * 0.55, half * 0.45):
        kind = "wicker" if rng.random() < 0.5 else "fabric"
        hat = Material(kind, one_of(rng, COATS), int(rng.integers(100)))
        parts.append(ball((0.12, y, 0.19), (0.2, 0.24, 0.12), hat, tile_m=0.3))
    return Piece.of(*parts)


def basket(
    rng: np.random.Generator,
    radius_m: float = 0.14,
    height_m: float = 0.5,
    colour: Rgb = (168, 130, 84),
    umbrellas: int = 3,
) -> Piece:
    """Round wicker basket; umbrellas stick out of it."""
    wicker = Material("wicker", colour, int(rng.integers(100)))
    parts = [post(0.0, 0.0, (0.0, height_m), radius_m, wicker, taper=1.1, tile_m=0.3)]
    for _ in range(umbrellas):
        x, y = (float(v) for v in rng.uniform(-0.5, 0.5, 2) * radius_m)
        ink: Rgb = one_of(rng, ((40, 46, 60), (150, 44, 44), (70, 96, 76)))
        z = (height_m - 0.1, height_m + float(rng.uniform(0.15, 0.3)))
        parts.append(post(x, y, z, 0.03, Material("fabric", ink, 1), solid=False, taper=0.4))
    return Piece.of(*parts)
