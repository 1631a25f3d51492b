"""Coat rack with hanging coats, hats and a scarf, all above the robot."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb, ball, box, detail, rounded

COATS: tuple[Rgb, ...] = ((66, 74, 92), (150, 112, 70), (118, 40, 46), (84, 98, 72), (190, 184, 172))


def coat_rack(
    rng: np.random.Generator, width_m: float = 1.0, coats: int = 4, colour: Rgb = (124, 88, 56)
) -> Piece:
    """Board with hooks on a wall at x = 0; the item's height is that of the board."""
    wood = Material("wood", colour, int(rng.integers(3)))
    half = width_m / 2
    parts = [
        box((0.0, 0.025), (-half, half), (-0.06, 0.06), wood),
        box((0.0, 0.22), (-half, half), (0.12, 0.14), wood),
    ]
    steel = Material("metal", (150, 150, 154), 3)
    for k in range(coats):
        y = -half + (k + 0.5) * width_m / coats
        parts.append(detail((0.02, 0.08), (y - 0.01, y + 0.01), (-0.02, 0.0), steel))
        cloth = Material("fabric", COATS[int(rng.integers(len(COATS)))], int(rng.integers(3)))
        long = float(rng.uniform(0.55, 0.75))
        parts += [
            Part(
                "drape",
                (0.08, y, -0.02 - long / 2),
                (0.1, width_m / coats * 0.8, long),
                cloth,
                solid=False,
                tile_m=0.5,
            ),
            rounded((0.07, y, -0.12), (0.1, width_m / coats * 0.75, 0.2), cloth, solid=False, tile_m=0.5),
        ]
    for y in (-half * 0.55, half * 0.45):
        hat = Material(
            "wicker" if rng.random() < 0.5 else "fabric",
            COATS[int(rng.integers(len(COATS)))],
            int(rng.integers(100)),
        )
        parts.append(ball((0.12, y, 0.19), (0.2, 0.24, 0.12), hat, tile_m=0.3))
    return Piece(tuple(parts))
