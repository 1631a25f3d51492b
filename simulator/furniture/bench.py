"""Television bench."""

import numpy as np

from simulator.furniture.stacks import book_pile, book_row, ornament
from simulator.scene.parts import Material, Piece, Rgb, box, detail, post


def tv_bench(
    rng: np.random.Generator,
    width_m: float = 1.8,
    depth_m: float = 0.42,
    height_m: float = 0.5,
    colour: Rgb = (206, 178, 138),
) -> Piece:
    """Low board, back at x = 0: drawers on both sides, an open middle with players and books."""
    wood = Material("wood", colour, int(rng.integers(3)))
    dark = Material("lacquer", (44, 44, 48), 7)
    half, third = width_m / 2, width_m / 6
    parts = [
        box((0.0, depth_m), (-half, half), (height_m - 0.03, height_m), wood, tile_m=0.8),
        box((0.0, depth_m), (-half, half), (0.1, 0.13), wood),
        box((0.0, 0.02), (-half, half), (0.13, height_m - 0.03), wood),
    ]
    for side in (-1, 1):
        y = sorted((side * third, side * half))
        parts.append(box((0.02, depth_m - 0.02), (y[0], y[1]), (0.13, height_m - 0.03), wood))
        for z in ((0.14, 0.29), (0.3, 0.46)):
            parts.append(box((depth_m - 0.02, depth_m), (y[0] + 0.008, y[1] - 0.008), z, wood, tile_m=0.5))
            middle = (y[0] + y[1]) / 2
            parts.append(
                detail(
                    (depth_m, depth_m + 0.012),
                    (middle - 0.06, middle + 0.06),
                    (z[1] - 0.05, z[1] - 0.035),
                    dark,
                )
            )
        parts.extend(post(x, side * (half - 0.08), (0.0, 0.1), 0.02, dark) for x in (0.08, depth_m - 0.08))
    parts.append(detail((0.05, 0.36), (-0.2, 0.2), (0.13, 0.2), dark))
    parts.extend(book_row(rng, depth_m - 0.06, (-0.28, 0.28), (0.23, 0.46)))
    parts.append(box((0.02, depth_m - 0.02), (-third, third), (0.21, 0.23), wood))
    parts.extend(
        ornament(rng, (0.2, half - 0.12, height_m)) + book_pile(rng, (0.2, -half + 0.18, height_m), 3)
    )
    return Piece(tuple(parts))
