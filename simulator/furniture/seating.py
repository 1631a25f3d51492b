"""Sofa, armchair, pouf: upholstered seats with legs and loose cushions."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import box, post, rounded
from simulator.textures.noise import one_of

LEG = Material("wood", (82, 58, 40), 3)


def sofa(
    rng: np.random.Generator,
    width_m: float = 2.1,
    depth_m: float = 0.9,
    colour: Rgb = (96, 110, 122),
    seats: int = 3,
) -> Piece:
    """Sofa; origin in the middle of its footprint, seat facing +x."""
    cloth = Material("fabric", colour, int(rng.integers(3)))
    arm = 0.2
    half = depth_m / 2
    parts = _carcass(cloth, width_m, depth_m, arm)
    step = (width_m - 2 * arm) / seats
    for k in range(seats):
        y = -width_m / 2 + arm + step * (k + 0.5)
        parts += [
            rounded((0.08, y, 0.39), (depth_m - 0.22, step - 0.01, 0.17), cloth, tile_m=0.7),
            rounded((-half + 0.27, y, 0.62), (0.2, step - 0.02, 0.42), cloth, tile_m=0.7),
        ]
    for y in (-width_m / 2 + arm + 0.22, width_m / 2 - arm - 0.22, 0.12):
        ink = Material("pattern_cloth", _accent(rng), int(rng.integers(3)))
        lean = float(rng.uniform(-0.3, 0.3))
        parts.append(
            rounded((-half + 0.42, y, 0.64), (0.14, 0.42, 0.4), ink, yaw_rad=lean, solid=False, tile_m=0.5)
        )
    return Piece.of(*parts)


def armchair(
    rng: np.random.Generator, width_m: float = 0.8, depth_m: float = 0.8, colour: Rgb = (150, 96, 60)
) -> Piece:
    """Leather armchair, facing +x."""
    hide = Material("leather", colour, int(rng.integers(3)))
    parts = _carcass(hide, width_m, depth_m, 0.15)
    parts += [
        rounded((0.06, 0.0, 0.4), (depth_m - 0.2, width_m - 0.31, 0.17), hide, tile_m=0.6),
        rounded((-depth_m / 2 + 0.22, 0.0, 0.68), (0.18, width_m - 0.26, 0.56), hide, tile_m=0.6),
    ]
    ink = Material("pattern_cloth", _accent(rng), int(rng.integers(3)))
    centre = (-depth_m / 2 + 0.37, 0.05, 0.62)
    parts.append(rounded(centre, (0.13, 0.38, 0.36), ink, yaw_rad=0.2, solid=False, tile_m=0.45))
    return Piece.of(*parts)


def pouf(
    rng: np.random.Generator, radius_m: float = 0.25, height_m: float = 0.4, colour: Rgb = (190, 160, 110)
) -> Piece:
    """Round upholstered stool."""
    cloth = Material("pattern_cloth", colour, int(rng.integers(3)))
    rim = rounded((0.0, 0.0, height_m - 0.03), (1.7 * radius_m, 1.7 * radius_m, 0.06), cloth, solid=False)
    return Piece((post(0.0, 0.0, (0.0, height_m - 0.02), radius_m, cloth, tile_m=0.6), rim))


def _carcass(cloth: Material, width: float, depth: float, arm: float) -> list[Part]:
    half_d, half_w = depth / 2, width / 2
    parts = [
        box((-half_d + 0.02, half_d - 0.03), (-half_w + 0.03, half_w - 0.03), (0.1, 0.32), cloth, tile_m=0.7),
        rounded((-half_d + 0.1, 0.0, 0.46), (0.2, width - 0.04, 0.74), cloth, tile_m=0.7),
    ]
    for side in (-1, 1):
        parts.append(
            rounded((0.0, side * (half_w - arm / 2), 0.36), (depth - 0.02, arm, 0.52), cloth, tile_m=0.7)
        )
        parts.extend(
            post(x, side * (half_w - 0.08), (0.0, 0.11), 0.022, LEG) for x in (-half_d + 0.08, half_d - 0.1)
        )
    return parts


def _accent(rng: np.random.Generator) -> Rgb:
    choices: tuple[Rgb, ...] = (
        (206, 178, 120),
        (178, 84, 62),
        (62, 92, 104),
        (226, 220, 206),
        (120, 132, 92),
    )
    return one_of(rng, choices)
