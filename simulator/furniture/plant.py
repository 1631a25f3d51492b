"""Pot plant."""

import numpy as np

from simulator.furniture.stacks import shade_of
from simulator.scene.parts import Material, Part, Piece, Rgb, post


def plant(
    rng: np.random.Generator,
    height_m: float = 1.2,
    pot_radius_m: float = 0.17,
    pot: Rgb = (176, 104, 74),
    leaf: Rgb = (62, 104, 50),
    leaves: int = 34,
) -> Piece:
    """Plant in a pot; leaves spread wider than the pot only above the robot."""
    clay = Material("ceramic", pot, int(rng.integers(3)))
    stem = Material("wood", (96, 78, 52), 2)
    parts: list[Part] = [
        post(0.0, 0.0, (0.0, 0.32), pot_radius_m, clay, taper=1.15, tile_m=0.4),
        post(0.0, 0.0, (0.32, height_m * 0.8), 0.015, stem, solid=False),
    ]
    for _ in range(leaves):
        z = float(rng.uniform(0.4, height_m))
        reach = float(rng.uniform(0.22, 0.4)) * (0.55 if z < 0.8 else 1.0)
        yaw, lift = float(rng.uniform(0, 2 * np.pi)), float(rng.uniform(-0.9, 0.1))
        green = Material("leaf", shade_of(rng, leaf, 32), 0)
        centre = (
            reach / 2 * np.cos(yaw) * np.cos(lift),
            reach / 2 * np.sin(yaw) * np.cos(lift),
            z - reach / 2 * np.sin(lift),
        )
        parts.append(
            Part(
                "leaf",
                centre,
                (reach, reach * 0.36, reach * 0.2),
                green,
                yaw_rad=yaw,
                pitch_rad=lift,
                solid=False,
                tile_m=None,
            )
        )
    return Piece(tuple(parts))
