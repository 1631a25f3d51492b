"""Television on the wall or a bench."""

import numpy as np

from simulator.scene.parts import Material, Piece, box, detail, label


def television(rng: np.random.Generator, width_m: float = 1.25, height_m: float = 0.72) -> Piece:
    """Flat screen facing +x, back at x = 0, lower edge at z = 0 of the item."""
    case = Material("lacquer", (24, 24, 26), 9)
    half = width_m / 2
    return Piece(
        (
            box((0.0, 0.05), (-half, half), (0.0, height_m), case),
            label(
                (0.05, 0.052),
                (-half + 0.012, half - 0.012),
                (0.02, height_m - 0.012),
                Material("screen", (34, 36, 42), int(rng.integers(100))),
            ),
            detail((-0.1, 0.14), (-0.16, 0.16), (-0.06, -0.045), case),
            detail((0.0, 0.04), (-0.04, 0.04), (-0.06, 0.0), case),
        )
    )
