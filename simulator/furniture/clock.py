"""Wall clock."""

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, detail, label


def clock(rng: np.random.Generator, size_m: float = 0.34, colour: Rgb = (240, 236, 224)) -> Piece:
    """Square wall clock facing +x, centre at the item's height."""
    half = size_m / 2
    return Piece(
        (
            detail((0.0, 0.03), (-half, half), (-half, half), Material("wood", (70, 50, 36), 2)),
            label(
                (0.03, 0.032),
                (-half + 0.02, half - 0.02),
                (-half + 0.02, half - 0.02),
                Material("clock", colour, int(rng.integers(1000))),
            ),
        )
    )
