"""What walls open with: a shut door, an open one, a window with curtains that shines into the room."""

import numpy as np

from simulator.scene.parts import Light, Material, Part, Piece, Rgb
from simulator.scene.shapes import around, detail, label


def door(
    rng: np.random.Generator, width_m: float = 0.88, height_m: float = 2.05, colour: Rgb = (226, 220, 206)
) -> Piece:
    """Door leaf with frame and handle on a wall at x = 0, facing +x."""
    del rng
    leaf, frame = Material("door", colour, 0), Material("lacquer", (238, 236, 230), 2)
    steel = Material("metal", (176, 176, 180), 4)
    half = width_m / 2
    parts = [label((0.0, 0.016), (-half, half), (0.0, height_m), leaf)]
    for side in (-1, 1):
        parts.append(detail((0.0, 0.028), (side * half, side * (half + 0.07)), (0.0, height_m + 0.07), frame))
    parts += [
        detail((0.0, 0.028), (-half - 0.07, half + 0.07), (height_m, height_m + 0.07), frame),
        detail((0.016, 0.022), (half - 0.09, half - 0.05), (0.94, 1.14), steel),
        detail((0.018, 0.05), (half - 0.08, half - 0.06), (1.05, 1.07), steel),
        detail((0.045, 0.06), (half - 0.19, half - 0.06), (1.05, 1.07), steel),
    ]
    return Piece.of(*parts)


def open_door(
    rng: np.random.Generator,
    width_m: float = 1.1,
    height_m: float = 2.1,
    depth_m: float = 0.15,
    colour: Rgb = (226, 220, 206),
) -> Piece:
    """Frame of an opening in a wall and its leaf, hinged at +y and opened by a right angle towards +x.

    The origin is the middle of the opening on that face of the wall; the frame is as deep as the wall.
    """
    del rng
    leaf, frame = Material("door", colour, 0), Material("lacquer", (238, 236, 230), 2)
    steel = Material("metal", (176, 176, 180), 4)
    half, wide = width_m / 2, 0.07
    parts = [detail((-depth_m, 0.0), around(0.0, half), (height_m - 0.02, height_m), frame)]
    for side in (-1, 1):
        edge = side * half
        parts.append(detail((-depth_m, 0.0), (edge, edge - side * 0.02), (0.0, height_m), frame))
        for face in ((0.0, 0.02), (-depth_m - 0.02, -depth_m)):
            parts.append(detail(face, (edge, edge + side * wide), (0.0, height_m + wide), frame))
    for face in ((0.0, 0.02), (-depth_m - 0.02, -depth_m)):
        parts.append(detail(face, around(0.0, half + wide), (height_m, height_m + wide), frame))
    thick, reach = (half + 0.02, half + 0.06), width_m - 0.04
    parts.append(label((0.03, reach), thick, (0.01, height_m - 0.03), leaf, solid=True))
    parts += [
        detail((reach - 0.09, reach - 0.05), (thick[0] - 0.006, thick[0]), (0.94, 1.14), steel),
        detail((reach - 0.19, reach - 0.06), (thick[0] - 0.045, thick[0] - 0.03), (1.05, 1.07), steel),
        detail((reach - 0.08, reach - 0.06), (thick[0] - 0.045, thick[0]), (1.05, 1.07), steel),
    ]
    return Piece.of(*parts)


def window(
    rng: np.random.Generator,
    width_m: float = 1.6,
    height_m: float = 1.35,
    panes: int = 2,
    daylight: float = 3.2,
    curtain: Rgb = (196, 178, 150),
    patterned: bool = False,
) -> Piece:
    """Window on a wall at x = 0 facing +x; the item's height is that of the sill."""
    white = Material("lacquer", (242, 242, 238), 3)
    outlook = Material("view", (150, 190, 232), int(rng.integers(1000)), glow=1.0)
    half = width_m / 2
    parts = [label((0.0, 0.006), (-half, half), (0.0, height_m), outlook, casts_shadow=False)]
    for k in range(panes + 1):
        y = -half + k * width_m / panes
        parts.append(detail((0.0, 0.045), around(y, 0.03), (0.0, height_m), white))
    for z in (0.0, height_m, height_m * 0.68):
        parts.append(detail((0.0, 0.045), (-half - 0.03, half + 0.03), around(z, 0.03), white))
    parts.append(detail((0.0, 0.16), (-half - 0.08, half + 0.08), (-0.05, -0.02), white))
    cloth = Material("pattern_cloth" if patterned else "fabric", curtain, int(rng.integers(1000)))
    low, high = -0.75, height_m + 0.18
    for side in (-1, 1):
        centre, size = (0.1, side * (half + 0.1), (low + high) / 2), (0.07, 0.46, high - low)
        parts.append(Part("drape", centre, size, cloth, solid=False, tile_m=0.6))
    rod = Material("metal", (120, 104, 84), 1)
    parts.append(detail((0.09, 0.11), (-half - 0.42, half + 0.42), (high, high + 0.02), rod))
    power = (0.95 * daylight, daylight, 1.08 * daylight)
    light = Light((0.05, 0.0, height_m / 2), (0.0, width_m, height_m), power, (1.0, 0.0, 0.0))
    return Piece(tuple(parts), (light,))
