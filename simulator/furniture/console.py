"""Narrow table for a hall or wall."""

import numpy as np

from simulator.furniture.stacks import book_pile, framed, ornament
from simulator.scene.parts import Material, Piece, Rgb, box, detail


def console_table(
    rng: np.random.Generator,
    width_m: float = 1.0,
    depth_m: float = 0.3,
    height_m: float = 0.79,
    colour: Rgb = (108, 74, 48),
) -> Piece:
    """Table with one drawer, a lower shelf and things on both; back at x = 0."""
    wood = Material("wood", colour, int(rng.integers(3)))
    half = width_m / 2
    parts = [
        box((0.0, depth_m), (-half, half), (height_m - 0.03, height_m), wood, tile_m=0.7),
        box((0.02, depth_m - 0.02), (-half + 0.02, half - 0.02), (height_m - 0.15, height_m - 0.03), wood),
        box((0.02, depth_m - 0.02), (-half + 0.02, half - 0.02), (0.16, 0.185), wood),
        detail(
            (depth_m - 0.02, depth_m - 0.01),
            (-0.04, 0.04),
            (height_m - 0.1, height_m - 0.08),
            Material("metal", (190, 186, 178), 2),
        ),
    ]
    parts.extend(
        box((x, x + 0.035), (y, y + 0.035), (0.0, height_m - 0.03), wood)
        for x in (0.01, depth_m - 0.045)
        for y in (-half + 0.01, half - 0.045)
    )
    basket = Material("wicker", (170, 134, 88), int(rng.integers(3)))
    parts.append(detail((0.04, depth_m - 0.04), (-half + 0.1, -0.05), (0.185, 0.42), basket, tile_m=0.3))
    parts.extend(book_pile(rng, (depth_m / 2, half - 0.28, 0.185), 6))
    parts.extend(
        ornament(rng, (depth_m / 2, -half + 0.17, height_m))
        + framed(rng, (depth_m / 2, 0.02, height_m))
        + book_pile(rng, (depth_m / 2, half - 0.22, height_m), 3)
    )
    return Piece(tuple(parts))
