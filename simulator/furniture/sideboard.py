"""Sideboard with doors, drawers and things on top."""

import numpy as np

from simulator.furniture.stacks import book_pile, framed, ornament
from simulator.scene.parts import Material, Piece, Rgb, box, detail, post


def sideboard(
    rng: np.random.Generator,
    width_m: float = 1.4,
    depth_m: float = 0.42,
    height_m: float = 0.8,
    colour: Rgb = (156, 112, 74),
    doors: int = 3,
) -> Piece:
    """Cabinet on legs with its back at x = 0."""
    wood = Material("wood", colour, int(rng.integers(3)))
    brass = Material("metal", (190, 160, 96), 2)
    half = width_m / 2
    parts = [box((0.0, depth_m - 0.02), (-half, half), (0.12, height_m), wood, tile_m=0.8)]
    step = width_m / doors
    for k in range(doors):
        y = (-half + k * step + 0.006, -half + (k + 1) * step - 0.006)
        face = Material("wood", colour, int(rng.integers(3)))
        rows = (
            ((0.14, 0.34), (0.35, 0.55), (0.56, height_m - 0.03))
            if k == doors // 2
            else ((0.14, height_m - 0.03),)
        )
        for z in rows:
            parts.append(box((depth_m - 0.02, depth_m), y, z, face, tile_m=0.7))
            knob = (y[0] + y[1]) / 2 if len(rows) > 1 else (y[1] - 0.05 if k == 0 else y[0] + 0.05)
            parts.append(
                detail(
                    (depth_m, depth_m + 0.02), (knob - 0.012, knob + 0.012), (z[1] - 0.12, z[1] - 0.06), brass
                )
            )
    parts.extend(
        post(x, y, (0.0, 0.12), 0.02, brass)
        for x in (0.06, depth_m - 0.06)
        for y in (-half + 0.06, half - 0.06)
    )
    for place in np.linspace(-half + 0.18, half - 0.18, max(2, int(width_m / 0.33))):
        choice = int(rng.integers(3))
        at = (0.2, float(place), height_m)
        parts.extend(
            ornament(rng, at)
            if choice == 0
            else framed(rng, at)
            if choice == 1
            else book_pile(rng, at, int(rng.integers(2, 6)))
        )
    return Piece(tuple(parts))
