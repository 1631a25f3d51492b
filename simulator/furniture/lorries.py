"""Vehicles of a works yard: lorry and forklift."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb, ball, box, detail, label, post, rounded

GLASS = Material("mirror", (78, 92, 104), 4)
TYRE = Material("fabric", (34, 34, 36), 1)
FRAME = Material("metal", (52, 54, 58), 2)
LAMP = Material("glow", (250, 246, 230), 2, 0.9)
RED = Material("lacquer", (180, 28, 30), 2)


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
        inner = tuple(sorted((s * 1.15, s * 1.18)))
        parts += [
            detail((2.5, 3.6), (inner[0], inner[1]), (1.8, 2.5), GLASS),
            detail((4.0, 4.06), (s * 0.95 - 0.16, s * 0.95 + 0.16), (0.65, 0.85), LAMP),
            detail((-4.06, -4.0), (s * 1.0 - 0.16, s * 1.0 + 0.16), (0.6, 0.75), RED),
        ]
        sign = Material("poster", (40, 92, 150), 2 + int(rng.integers(4)))
        outer = tuple(sorted((s * 1.25, s * 1.26)))
        parts.append(label((-2.6, 0.4), (outer[0], outer[1]), (1.6, 2.8), sign))
        for x in (-3.1, -2.1, 3.0):
            parts.append(_wheel(x, s * 1.05, 0.5))
    for at in (-0.6, 0.0, 0.6):
        parts.append(detail((-4.03, -4.0), (at - 0.02, at + 0.02), (1.0, 3.3), FRAME))
    return Piece(tuple(parts))


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
        *(box((0.8, 1.8), (y - 0.06, y + 0.06), (0.03, 0.09), FRAME) for y in (-0.28, 0.28)),
        *(
            ball((x, y, 0.26), (0.52, 0.2, 0.52), TYRE, tile_m=0.4)
            for x in (-0.8, 0.4)
            for y in (-0.55, 0.55)
        ),
    ]
    return Piece(tuple(parts))
