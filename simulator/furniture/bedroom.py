"""What stands in a bedroom: bed, wardrobe, bedside table, and a bag on the floor."""

import numpy as np

from simulator.furniture.office import STEEL
from simulator.furniture.stacks import book_pile
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, box, detail, post, rounded

LINEN = Material("fabric", (236, 232, 224), 1)


def bed(
    rng: np.random.Generator,
    length_m: float = 2.0,
    width_m: float = 0.95,
    colour: Rgb = (150, 112, 76),
    blanket: Rgb = (72, 98, 128),
) -> Piece:
    """Single bed, its head at x = 0 and its foot along +x: frame, mattress, pillow, folded-back blanket."""
    wood, half = Material("wood", colour, int(rng.integers(3))), width_m / 2
    cover = Material("fabric", blanket, int(rng.integers(3)))
    stripe = Material("pattern_cloth", blanket, int(rng.integers(3)))
    parts: list[Part] = [
        box((0.0, 0.04), (-half, half), (0.0, 0.92), wood, tile_m=0.9),
        box((length_m - 0.04, length_m), (-half, half), (0.0, 0.48), wood, tile_m=0.9),
        box((0.04, length_m - 0.04), (-half + 0.02, half - 0.02), (0.18, 0.3), wood, tile_m=0.9),
        rounded((length_m / 2, 0.0, 0.4), (length_m - 0.1, width_m - 0.06, 0.22), LINEN, tile_m=0.7),
        rounded((0.32, 0.0, 0.55), (0.4, width_m - 0.25, 0.14), LINEN, solid=False, tile_m=0.5),
    ]
    low, high = 0.85, length_m - 0.045
    parts += [
        rounded(
            ((low + high) / 2, 0.0, 0.42), (high - low, width_m + 0.02, 0.26), cover, solid=False, tile_m=0.7
        ),
        rounded((low - 0.06, 0.0, 0.53), (0.24, width_m, 0.06), stripe, solid=False, tile_m=0.5),
    ]
    return Piece.of(*parts)


def wardrobe(
    rng: np.random.Generator,
    width_m: float = 1.1,
    depth_m: float = 0.6,
    height_m: float = 2.05,
    colour: Rgb = (196, 164, 122),
) -> Piece:
    """Wardrobe with two doors, its back at x = 0; a box lies on top."""
    wood, half = Material("wood", colour, int(rng.integers(3))), width_m / 2
    parts: list[Part] = [
        box((0.0, depth_m - 0.02), (-half, half), (0.0, height_m), wood, tile_m=1.1),
        detail((0.0, depth_m + 0.01), (-half - 0.01, half + 0.01), (height_m, height_m + 0.03), wood),
    ]
    for side in (-1, 1):
        inner, outer = side * 0.004, side * (half - 0.01)
        span = (min(inner, outer), max(inner, outer))
        parts += [
            detail((depth_m - 0.02, depth_m), span, (0.08, height_m - 0.02), wood, tile_m=0.9),
            detail((depth_m, depth_m + 0.03), around(side * 0.05, 0.008), (0.95, 1.15), STEEL),
        ]
    carton = Material("planks", (190, 156, 112), int(rng.integers(3)))
    top = height_m + 0.03
    parts.append(detail((0.1, 0.45), (-half + 0.1, -half + 0.6), (top, top + 0.24), carton, tile_m=0.5))
    return Piece.of(*parts)


def bedside_table(
    rng: np.random.Generator, width_m: float = 0.4, height_m: float = 0.5, colour: Rgb = (150, 112, 76)
) -> Piece:
    """Small cabinet with a drawer over an open shelf, its back at x = 0; books on both."""
    wood, half, deep = Material("wood", colour, int(rng.integers(3))), width_m / 2, 0.36
    parts: list[Part] = [
        box((0.0, deep), (-half, half), (height_m - 0.02, height_m), wood),
        box((0.0, deep), (-half, half), (0.06, 0.08), wood),
        detail((0.0, 0.015), (-half, half), (0.08, height_m - 0.02), wood),
        detail((0.02, deep - 0.005), (-half + 0.02, half - 0.02), (height_m - 0.18, height_m - 0.02), wood),
        detail((deep - 0.005, deep + 0.015), (-0.05, 0.05), (height_m - 0.11, height_m - 0.095), STEEL),
    ]
    for side in (-1, 1):
        y = sorted((side * half, side * (half - 0.02)))
        parts.append(box((0.0, deep), (y[0], y[1]), (0.0, height_m - 0.02), wood))
    parts += book_pile(rng, (0.2, 0.0, 0.08), 4)
    parts += book_pile(rng, (0.24, half - 0.14, height_m), 2)
    return Piece.of(*parts)


def backpack(rng: np.random.Generator, colour: Rgb = (150, 66, 52)) -> Piece:
    """A packed bag that stands on the floor, its pocket towards +x."""
    cloth, dark = Material("fabric", colour, int(rng.integers(3))), Material("fabric", (46, 46, 50), 1)
    parts: list[Part] = [
        rounded((0.0, 0.0, 0.25), (0.24, 0.34, 0.5), cloth, tile_m=0.4),
        rounded((0.13, 0.0, 0.19), (0.1, 0.26, 0.24), dark, solid=False, tile_m=0.4),
        detail((-0.02, 0.02), (-0.06, 0.06), (0.5, 0.53), dark),
        post(0.0, 0.0, (0.5, 0.6), 0.09, Material("fabric", (196, 186, 160), 2), solid=False, tile_m=0.4),
    ]
    return Piece.of(*parts)
