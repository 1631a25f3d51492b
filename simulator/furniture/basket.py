"""Basket or umbrella stand."""

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, post


def basket(
    rng: np.random.Generator,
    radius_m: float = 0.14,
    height_m: float = 0.5,
    colour: Rgb = (168, 130, 84),
    umbrellas: int = 3,
) -> Piece:
    """Round wicker basket; umbrellas stick out of it."""
    parts = [
        post(
            0.0,
            0.0,
            (0.0, height_m),
            radius_m,
            Material("wicker", colour, int(rng.integers(100))),
            taper=1.1,
            tile_m=0.3,
        )
    ]
    for _ in range(umbrellas):
        x, y = (float(v) for v in rng.uniform(-0.5, 0.5, 2) * radius_m)
        ink: Rgb = ((40, 46, 60), (150, 44, 44), (70, 96, 76))[int(rng.integers(3))]
        parts.append(
            post(
                x,
                y,
                (height_m - 0.1, height_m + float(rng.uniform(0.15, 0.3))),
                0.03,
                Material("fabric", ink, 1),
                solid=False,
                taper=0.4,
            )
        )
    return Piece(tuple(parts))
