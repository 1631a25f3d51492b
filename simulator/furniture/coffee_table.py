"""Low table with books, a tray and a plant."""

import numpy as np

from simulator.furniture.stacks import book_pile
from simulator.scene.parts import Material, Piece, Rgb, ball, box, detail, post


def coffee_table(
    rng: np.random.Generator,
    length_m: float = 1.0,
    width_m: float = 0.55,
    height_m: float = 0.4,
    colour: Rgb = (120, 84, 54),
) -> Piece:
    """Low table, long side along y, with a shelf near the floor."""
    wood = Material("wood", colour, int(rng.integers(3)))
    hw, hl = width_m / 2, length_m / 2
    parts = [
        box((-hw, hw), (-hl, hl), (height_m - 0.04, height_m), wood, tile_m=0.8),
        box((-hw + 0.05, hw - 0.05), (-hl + 0.05, hl - 0.05), (0.1, 0.125), wood),
    ]
    parts.extend(
        box(
            (sx * (hw - 0.07), sx * (hw - 0.02)),
            (sy * (hl - 0.07), sy * (hl - 0.02)),
            (0.0, height_m - 0.04),
            wood,
        )
        for sx in (-1, 1)
        for sy in (-1, 1)
    )
    parts.extend(book_pile(rng, (0.02, -0.2, height_m), 4))
    parts.extend(book_pile(rng, (0.0, 0.15, 0.125), 5))
    tray = Material("lacquer", (62, 70, 74), 4)
    parts.append(detail((-0.15, 0.15), (0.08, 0.42), (height_m, height_m + 0.02), tray))
    cup = Material("ceramic", (222, 208, 186), int(rng.integers(3)))
    parts.extend(
        post(x, y, (height_m + 0.02, height_m + 0.11), 0.038, cup, solid=False, tile_m=0.2)
        for x, y in ((-0.06, 0.2), (0.06, 0.31))
    )
    parts.append(
        ball(
            (0.05, 0.17, height_m + 0.07),
            (0.1, 0.1, 0.1),
            Material("ceramic", (104, 130, 116), 8),
            tile_m=0.2,
        )
    )
    return Piece(tuple(parts))
