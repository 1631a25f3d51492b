"""What guests meet first: a reception desk, a rack of leaflets, and what hangs there for emergencies."""

import numpy as np

from simulator.furniture.office import STEEL
from simulator.furniture.stacks import any_colour, ornament
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, box, detail, label, post

DARK = Material("lacquer", (40, 42, 46), 3)


def reception_desk(
    rng: np.random.Generator, length_m: float = 1.8, depth_m: float = 0.7, colour: Rgb = (140, 98, 62)
) -> Piece:
    """Counter along y in the middle of its footprint: guests stand on +x, a lower worktop lies behind."""
    wood, top = Material("wood", colour, int(rng.integers(3))), Material("wood", (214, 196, 164), 1)
    front, half = depth_m / 2, length_m / 2
    parts: list[Part] = [
        box((front - 0.1, front), (-half, half), (0.0, 1.06), wood, tile_m=1.0),
        box((front - 0.22, front + 0.06), (-half - 0.03, half + 0.03), (1.06, 1.1), top, tile_m=1.1),
        box((-front, front - 0.1), (-half, half), (0.7, 0.74), top, tile_m=1.1),
        box((-front, front - 0.1), (-half, -half + 0.04), (0.0, 0.7), wood),
        box((-front, front - 0.1), (half - 0.04, half), (0.0, 0.7), wood),
    ]
    for k in range(3):
        y = -half + (k + 0.5) * length_m / 3
        face = (front, front + 0.012)
        parts.append(detail(face, around(y, length_m / 6 - 0.04), (0.14, 0.96), wood, tile_m=0.8))
    page = Material("display", (72, 110, 150), int(rng.integers(6)), glow=0.85)
    parts += [
        detail((-0.02, 0.01), around(0.2, 0.26), (0.86, 1.2), DARK),
        label((-0.022, -0.02), around(0.2, 0.25), (0.88, 1.18), page),
        detail((-0.05, 0.05), around(0.2, 0.1), (0.74, 0.86), DARK),
        post(front - 0.05, -half + 0.3, (1.1, 1.14), 0.045, STEEL, solid=False, taper=0.6),
        *ornament(rng, (front - 0.1, half - 0.3, 1.1)),
    ]
    return Piece.of(*parts)


def leaflet_rack(rng: np.random.Generator, width_m: float = 0.7, rows: int = 4) -> Piece:
    """Shelves of leaflets on a wall at x = 0; the item's height is its lower edge."""
    frame, half = Material("lacquer", (226, 226, 222), 5), width_m / 2
    parts: list[Part] = [detail((0.0, 0.02), (-half, half), (0.0, 0.32 * rows), frame)]
    for row in range(rows):
        z = 0.02 + 0.32 * row
        parts.append(detail((0.02, 0.1), (-half, half), (z, z + 0.09), frame))
        for k in range(int(width_m / 0.14)):
            sheet = Material("poster", any_colour(rng, 60, 240), int(rng.integers(6)))
            y = -half + 0.07 + 0.14 * k
            parts.append(label((0.03, 0.06), around(y, 0.05), (z + 0.02, z + 0.24), sheet))
    return Piece.of(*parts)


def fire_extinguisher(rng: np.random.Generator) -> Piece:
    """Red bottle on a wall at x = 0 with its sign above; the item's height is its lower edge."""
    del rng
    red, white = Material("lacquer", (186, 28, 30), 2), Material("panel", (236, 236, 232), 4)
    parts: list[Part] = [
        post(0.1, 0.0, (0.0, 0.46), 0.075, red, solid=False, tile_m=0.5),
        post(0.1, 0.0, (0.46, 0.52), 0.075, red, solid=False, taper=0.4),
        post(0.1, 0.0, (0.52, 0.57), 0.022, DARK, solid=False),
        detail((0.08, 0.2), (-0.015, 0.015), (0.56, 0.585), DARK),
        label((0.17, 0.178), (-0.045, 0.045), (0.14, 0.32), white),
        detail((0.0, 0.03), (-0.03, 0.03), (0.2, 0.5), STEEL),
        detail((0.0, 0.008), (-0.1, 0.1), (0.85, 1.05), red),
        detail((0.008, 0.01), (-0.035, 0.035), (0.88, 1.02), Material("lacquer", (240, 240, 236), 6)),
    ]
    return Piece.of(*parts)
