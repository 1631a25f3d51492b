"""Shallow shoe cabinet with flaps and things on top."""

from itertools import pairwise

import numpy as np

from simulator.furniture.stacks import framed, ornament
from simulator.scene.parts import Material, Piece, Rgb, box, detail


def shoe_cabinet(
    rng: np.random.Generator,
    width_m: float = 1.0,
    depth_m: float = 0.22,
    height_m: float = 0.95,
    colour: Rgb = (206, 198, 184),
) -> Piece:
    """Cabinet with its back at x = 0."""
    paint, knob = Material("lacquer", colour, int(rng.integers(100))), Material("wood", (120, 84, 54), 3)
    half = width_m / 2
    parts = [
        box((0.0, depth_m - 0.02), (-half, half), (0.05, height_m - 0.02), paint, tile_m=0.6),
        box(
            (0.0, depth_m + 0.01),
            (-half - 0.01, half + 0.01),
            (height_m - 0.02, height_m),
            Material("wood", (166, 122, 80), 8),
        ),
        box((0.02, depth_m - 0.04), (-half + 0.02, half - 0.02), (0.0, 0.05), paint),
    ]
    rows = np.linspace(0.06, height_m - 0.03, 4)
    for low, high in pairwise(rows):
        for y in ((-half, -0.004), (0.004, half)):
            parts.append(
                box(
                    (depth_m - 0.02, depth_m), y, (float(low) + 0.004, float(high) - 0.004), paint, tile_m=0.5
                )
            )
            middle = (y[0] + y[1]) / 2
            parts.append(
                detail(
                    (depth_m, depth_m + 0.02),
                    (middle - 0.05, middle + 0.05),
                    (float(high) - 0.06, float(high) - 0.045),
                    knob,
                )
            )
    parts.extend(
        ornament(rng, (depth_m / 2, -half + 0.2, height_m))
        + framed(rng, (depth_m / 2, 0.1, height_m))
        + ornament(rng, (depth_m / 2, half - 0.2, height_m))
    )
    return Piece(tuple(parts))
