"""A parked car."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb, ball, box, detail, label, rounded

GLASS = Material("mirror", (84, 98, 110), 4)
TYRE = Material("fabric", (36, 36, 38), 1)


def car(rng: np.random.Generator, colour: Rgb = (148, 40, 44)) -> Piece:
    """A small car, front along +x, 3.9 m long."""
    del rng
    paint = Material("lacquer", colour, 6)
    parts: list[Part] = [
        box((-1.9, 1.9), (-0.82, 0.82), (0.28, 0.82), paint, tile_m=1.4),
        rounded((0.0, 0.0, 0.62), (3.96, 1.72, 0.62), paint, solid=False, tile_m=1.4),
        rounded((-0.25, 0.0, 1.12), (2.3, 1.5, 0.82), GLASS, solid=False, tile_m=1.2),
        rounded((-0.3, 0.0, 1.46), (1.6, 1.38, 0.18), paint, solid=False, tile_m=1.2),
        box((-1.7, 1.7), (-0.7, 0.7), (0.1, 0.28), Material("metal", (40, 42, 44), 1)),
    ]
    for x in (-1.2, 1.25):
        for y in (-0.8, 0.8):
            parts.append(_wheel(x, y))
    for y in (-0.58, 0.58):
        parts += [
            detail(
                (1.9, 1.98), (y - 0.18, y + 0.18), (0.55, 0.72), Material("glow", (250, 246, 230), 2, 0.9)
            ),
            detail((-1.98, -1.9), (y - 0.16, y + 0.16), (0.6, 0.76), Material("lacquer", (176, 26, 30), 2)),
        ]
    parts += [
        label((1.96, 2.0), (-0.26, 0.26), (0.4, 0.52), Material("panel", (240, 240, 236), 5)),
        label((-2.0, -1.96), (-0.26, 0.26), (0.45, 0.57), Material("panel", (240, 240, 236), 6)),
    ]
    return Piece(tuple(parts))


def _wheel(x: float, y: float) -> Part:
    return ball((x, y, 0.31), (0.62, 0.24, 0.62), TYRE, tile_m=0.4)
