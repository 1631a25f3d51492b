"""Rugs: flat, not solid."""

from typing import Literal

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, detail, label


def rug(
    rng: np.random.Generator,
    length_m: float = 2.4,
    width_m: float = 1.7,
    style: Literal["persian", "kilim", "modern"] = "persian",
    colour: Rgb = (150, 46, 44),
) -> Piece:
    """Rug with its long side along y."""
    del rng
    cloth = Material(style, colour, int(1000 * length_m))
    body = label(
        (-width_m / 2, width_m / 2), (-length_m / 2, length_m / 2), (0.0, 0.008), cloth, casts_shadow=False
    )
    fringe = Material("fabric", (222, 210, 184), 2)
    end = length_m / 2
    ends = tuple(
        detail((-width_m / 2, width_m / 2), y, (0.0, 0.005), fringe, tile_m=0.2, casts_shadow=False)
        for y in ((-end - 0.05, -end), (end, end + 0.05))
    )
    return Piece((body, *ends))
