"""Ceiling light, light panel, floor lamp, table lamp, and light without any lamp."""

import numpy as np

from simulator.scene.parts import Light, Material, Piece, Rgb
from simulator.scene.shapes import around, detail, post

SHADE: Rgb = (255, 244, 220)
WARM = np.array([1.0, 0.9, 0.76])


def _power(strength: float) -> tuple[float, float, float]:
    r, g, b = (WARM * strength).tolist()
    return r, g, b


def ceiling_light(rng: np.random.Generator, radius_m: float = 0.22, strength: float = 3.6) -> Piece:
    """Flat round ceiling light; the item's height is that of the ceiling."""
    del rng
    shade = Material("glow", SHADE, 1, glow=1.0)
    rim = Material("metal", (180, 180, 182), 1)
    parts = (
        post(0.0, 0.0, (-0.03, 0.0), radius_m, rim, solid=False, casts_shadow=False),
        post(0.0, 0.0, (-0.1, -0.03), radius_m * 0.94, shade, solid=False, casts_shadow=False, taper=1.05),
    )
    return Piece(parts, (Light((0.0, 0.0, -0.12), (radius_m, radius_m, 0.02), _power(strength)),))


def light_panel(
    rng: np.random.Generator, length_m: float = 0.6, width_m: float = 0.6, strength: float = 3.6
) -> Piece:
    """Panel in the ceiling that shines, long side along y; the item's height is that of the ceiling."""
    del rng
    frame = Material("lacquer", (246, 246, 244), 1)
    shade = Material("glow", (250, 252, 255), 3, glow=1.0)
    half = width_m / 2, length_m / 2
    lit = half[0] - 0.03, half[1] - 0.03
    parts = (
        detail(around(0.0, half[0]), around(0.0, half[1]), (-0.015, 0.0), frame, casts_shadow=False),
        detail(around(0.0, lit[0]), around(0.0, lit[1]), (-0.018, -0.015), shade, casts_shadow=False),
    )
    cool = (0.96 * strength, 0.98 * strength, strength)
    return Piece(parts, (Light((0.0, 0.0, -0.04), (width_m, length_m, 0.01), cool),))


def floor_lamp(rng: np.random.Generator, height_m: float = 1.6, strength: float = 0.7) -> Piece:
    """Standing lamp with a cloth shade."""
    del rng
    steel = Material("metal", (96, 92, 88), 3)
    shade = Material("glow", (255, 228, 184), 2, glow=0.95)
    parts = (
        post(0.0, 0.0, (0.0, 0.03), 0.14, steel),
        post(0.0, 0.0, (0.03, height_m - 0.28), 0.014, steel),
        post(0.0, 0.0, (height_m - 0.3, height_m), 0.2, shade, solid=False, taper=0.7, casts_shadow=False),
    )
    return Piece(parts, (Light((0.0, 0.0, height_m), (0.1, 0.1, 0.1), _power(strength)),))


def table_lamp(rng: np.random.Generator, strength: float = 0.35, colour: Rgb = (88, 112, 120)) -> Piece:
    """Small lamp; stands at the item's height."""
    foot = Material("ceramic", colour, int(rng.integers(3)))
    shade = Material("glow", (255, 230, 190), 2, glow=0.95)
    parts = (
        post(0.0, 0.0, (0.0, 0.22), 0.07, foot, solid=False, taper=0.4, tile_m=0.3),
        post(0.0, 0.0, (0.22, 0.42), 0.13, shade, solid=False, taper=0.7, casts_shadow=False),
    )
    return Piece(parts, (Light((0.0, 0.0, 0.44), (0.06, 0.06, 0.06), _power(strength)),))


def light(
    rng: np.random.Generator, strength: float = 3.6, colour: Rgb = (255, 255, 255), clear_m: float = 0.6
) -> Piece:
    """Light without a lamp, for models that bring theirs; what is within `clear_m` of it casts no shadow."""
    del rng
    r, g, b = (strength * (channel / 255.0) for channel in colour)
    return Piece((), (Light((0.0, 0.0, 0.0), (0.1, 0.1, 0.1), (r, g, b), clear_m=clear_m),))
