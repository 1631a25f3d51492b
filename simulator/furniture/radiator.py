"""Panel radiator."""

import numpy as np

from simulator.scene.parts import Material, Piece, box, detail


def radiator(rng: np.random.Generator, width_m: float = 0.9, height_m: float = 0.6) -> Piece:
    """Radiator on a wall at x = 0, facing +x."""
    del rng
    face, steel = Material("radiator", (236, 236, 232), 1), Material("metal", (190, 190, 190), 3)
    half = width_m / 2
    return Piece(
        (
            box((0.03, 0.1), (-half, half), (0.14, 0.14 + height_m), face, tile_m=None),
            detail((0.05, 0.08), (half, half + 0.06), (0.16, 0.2), steel),
            detail((0.05, 0.08), (half + 0.04, half + 0.06), (0.0, 0.2), steel),
        )
    )
