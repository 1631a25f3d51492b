"""Bookshelf full of books."""

import numpy as np

from simulator.furniture.stacks import book_row, ornament
from simulator.scene.parts import Material, Part, Piece, Rgb, box


def bookshelf(
    rng: np.random.Generator,
    width_m: float = 1.8,
    height_m: float = 2.0,
    depth_m: float = 0.3,
    shelves: int = 6,
    bays: int = 2,
    colour: Rgb = (140, 98, 62),
) -> Piece:
    """Open shelves with the back at x = 0 (against a wall), front along +x."""
    wood = Material("wood", colour, int(rng.integers(3)))
    half, t = width_m / 2, 0.025
    parts: list[Part] = [box((0.0, 0.012), (-half, half), (0.0, height_m), wood)]
    bay = (width_m - t) / bays
    parts.extend(
        box((0.0, depth_m), (-half + k * bay, -half + k * bay + t), (0.0, height_m), wood)
        for k in range(bays + 1)
    )
    step = (height_m - 0.06 - t) / shelves
    for row in range(shelves + 1):
        z = 0.06 + row * step
        parts.append(box((0.0, depth_m), (-half, half), (z, z + t), wood))
    parts.append(box((0.02, depth_m - 0.02), (-half, half), (0.0, 0.06), wood))
    for row in range(shelves):
        for k in range(bays):
            side = (-half + k * bay + t + 0.01, -half + (k + 1) * bay - 0.01)
            level = (0.06 + row * step + t, 0.06 + (row + 1) * step - 0.02)
            until = side[1]
            if rng.random() < 0.4:
                until = side[0] + float(rng.uniform(0.5, 0.7)) * (side[1] - side[0])
                parts.extend(ornament(rng, (depth_m - 0.12, (until + side[1]) / 2 + 0.03, level[0])))
            parts.extend(book_row(rng, depth_m - 0.02, (side[0], until), level))
    return Piece(tuple(parts))
