"""A shut door: all doors are identical."""

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, detail, label


def door(
    rng: np.random.Generator, width_m: float = 0.88, height_m: float = 2.05, colour: Rgb = (226, 220, 206)
) -> Piece:
    """Door leaf with frame and handle on a wall at x = 0, facing +x."""
    del rng
    leaf, frame = Material("door", colour, 0), Material("lacquer", (238, 236, 230), 2)
    steel = Material("metal", (176, 176, 180), 4)
    half = width_m / 2
    parts = [label((0.0, 0.016), (-half, half), (0.0, height_m), leaf)]
    for side in (-1, 1):
        y = sorted((side * half, side * (half + 0.07)))
        parts.append(detail((0.0, 0.028), (y[0], y[1]), (0.0, height_m + 0.07), frame))
    parts += [
        detail((0.0, 0.028), (-half - 0.07, half + 0.07), (height_m, height_m + 0.07), frame),
        detail((0.016, 0.022), (half - 0.09, half - 0.05), (0.94, 1.14), steel),
        detail((0.018, 0.05), (half - 0.08, half - 0.06), (1.05, 1.07), steel),
        detail((0.045, 0.06), (half - 0.19, half - 0.06), (1.05, 1.07), steel),
    ]
    return Piece(tuple(parts))
