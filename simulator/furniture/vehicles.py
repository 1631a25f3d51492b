"""Vehicles: a parked car, a lorry and a forklift."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, ball, box, detail, label, post, rounded

CAR_GLASS = Material("mirror", (84, 98, 110), 4)
CAR_TYRE = Material("fabric", (36, 36, 38), 1)
GLASS = Material("mirror", (78, 92, 104), 4)
TYRE = Material("fabric", (34, 34, 36), 1)
FRAME = Material("metal", (52, 54, 58), 2)
LAMP = Material("glow", (250, 246, 230), 2, 0.9)
RED = Material("lacquer", (180, 28, 30), 2)


def car(rng: np.random.Generator, colour: Rgb = (148, 40, 44)) -> Piece:
    """A small car, front along +x, 3.9 m long."""
    del rng
    paint = Material("lacquer", colour, 6)
    parts: list[Part] = [
        box((-1.9, 1.9), (-0.82, 0.82), (0.28, 0.82), paint, tile_m=1.4),
        rounded((0.0, 0.0, 0.62), (3.96, 1.72, 0.62), paint, solid=False, tile_m=1.4),
        rounded((-0.25, 0.0, 1.12), (2.3, 1.5, 0.82), CAR_GLASS, solid=False, tile_m=1.2),
        rounded((-0.3, 0.0, 1.46), (1.6, 1.38, 0.18), paint, solid=False, tile_m=1.2),
        box((-1.7, 1.7), (-0.7, 0.7), (0.1, 0.28), Material("metal", (40, 42, 44), 1)),
    ]
    for x in (-1.2, 1.25):
        for y in (-0.8, 0.8):
            parts.append(ball((x, y, 0.31), (0.62, 0.24, 0.62), CAR_TYRE, tile_m=0.4))
    for y in (-0.58, 0.58):
        parts += [
            detail((1.9, 1.98), around(y, 0.18), (0.55, 0.72), LAMP),
            detail((-1.98, -1.9), around(y, 0.16), (0.6, 0.76), Material("lacquer", (176, 26, 30), 2)),
        ]
    parts += [
        label((1.96, 2.0), (-0.26, 0.26), (0.4, 0.52), Material("panel", (240, 240, 236), 5)),
        label((-2.0, -1.96), (-0.26, 0.26), (0.45, 0.57), Material("panel", (240, 240, 236), 6)),
    ]
    return Piece.of(*parts)


def truck(rng: np.random.Generator, cab: Rgb = (178, 40, 38), side: Rgb = (226, 228, 226)) -> Piece:
    """Box lorry, 8 m long, front along +x; its sides are large and plain."""
    paint, plain = Material("lacquer", cab, 4), Material("lacquer", side, 6)
    parts: list[Part] = [
        box((-4.0, 4.0), (-1.0, 1.0), (0.35, 0.95), FRAME, tile_m=1.2),
        box((-4.0, 1.9), (-1.25, 1.25), (0.95, 3.4), plain, tile_m=3.0),
        detail((-4.02, 1.92), (-1.27, 1.27), (0.93, 1.05), FRAME),
        box((2.1, 4.0), (-1.2, 1.2), (0.5, 1.75), paint, tile_m=1.6),
        detail((2.15, 3.85), (-1.15, 1.15), (1.75, 2.75), paint, tile_m=1.6),
        detail((3.85, 3.88), (-1.05, 1.05), (1.75, 2.55), GLASS),
        detail((4.0, 4.05), (-0.8, 0.8), (0.85, 1.35), FRAME),
        box((4.0, 4.1), (-1.22, 1.22), (0.3, 0.6), FRAME),
        box((-3.2, 1.6), (-1.2, -1.14), (0.4, 0.85), Material("metal", (150, 152, 156), 3), tile_m=1.0),
        box((-3.2, 1.6), (1.14, 1.2), (0.4, 0.85), Material("metal", (150, 152, 156), 3), tile_m=1.0),
    ]
    for s in (-1.0, 1.0):
        parts += [
            detail((2.5, 3.6), (s * 1.15, s * 1.18), (1.8, 2.5), GLASS),
            detail((4.0, 4.06), around(s * 0.95, 0.16), (0.65, 0.85), LAMP),
            detail((-4.06, -4.0), around(s * 1.0, 0.16), (0.6, 0.75), RED),
        ]
        sign = Material("poster", (40, 92, 150), 2 + int(rng.integers(4)))
        parts.append(label((-2.6, 0.4), (s * 1.25, s * 1.26), (1.6, 2.8), sign))
        for x in (-3.1, -2.1, 3.0):
            parts.append(_wheel(x, s * 1.05, 0.5))
    for at in (-0.6, 0.0, 0.6):
        parts.append(detail((-4.03, -4.0), around(at, 0.02), (1.0, 3.3), FRAME))
    return Piece.of(*parts)


def _wheel(x: float, y: float, radius: float) -> Part:
    size = (2 * radius, 0.34, 2 * radius)
    return Part("ellipsoid", (x, y, radius), size, TYRE, tile_m=0.5)


def forklift(rng: np.random.Generator, colour: Rgb = (226, 150, 30)) -> Piece:
    """Forklift, forks towards +x and resting on the floor."""
    del rng
    paint = Material("lacquer", colour, 3)
    parts: list[Part] = [
        box((-1.1, 0.7), (-0.55, 0.55), (0.12, 0.75), paint, tile_m=1.0),
        detail((-1.1, -0.5), (-0.55, 0.55), (0.75, 1.15), paint, tile_m=1.0),
        rounded((-0.35, 0.0, 0.92), (0.55, 0.5, 0.3), TYRE, solid=False),
        box((0.7, 0.8), (-0.5, -0.38), (0.05, 2.2), FRAME),
        box((0.7, 0.8), (0.38, 0.5), (0.05, 2.2), FRAME),
        detail((0.7, 0.8), (-0.5, 0.5), (2.1, 2.2), FRAME),
        detail((-1.0, 0.5), (-0.5, 0.5), (2.02, 2.1), FRAME),
        *(post(x, y, (0.75, 2.02), 0.03, FRAME, solid=False) for x in (-0.95, 0.45) for y in (-0.45, 0.45)),
        *(box((0.8, 1.8), around(y, 0.06), (0.03, 0.09), FRAME) for y in (-0.28, 0.28)),
        *(
            ball((x, y, 0.26), (0.52, 0.2, 0.52), TYRE, tile_m=0.4)
            for x in (-0.8, 0.4)
            for y in (-0.55, 0.55)
        ),
    ]
    return Piece.of(*parts)
