"""Pictures on a wall."""

from typing import Literal

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, detail, label


def picture(
    rng: np.random.Generator,
    width_m: float = 0.7,
    height_m: float = 0.55,
    style: Literal["landscape", "abstract", "still_life", "street", "poster"] = "landscape",
    frame: Rgb = (60, 44, 34),
    mount_m: float = 0.04,
    variant: int = 0,
) -> Piece:
    """Framed picture facing +x, its centre at the item's height; `variant` picks a picture of the style."""
    wood = Material("wood", frame, 4)
    card = Material("lacquer", (238, 234, 224), 3)
    canvas = Material(style, (200, 180, 150), variant if variant else int(rng.integers(100_000)))
    half, tall, edge = width_m / 2, height_m / 2, 0.025
    parts = [detail((0.0, 0.012), (-half, half), (-tall, tall), card)]
    for sign in (-1, 1):
        y = tuple(sorted((sign * half, sign * (half - edge))))
        z = tuple(sorted((sign * tall, sign * (tall - edge))))
        parts += [
            detail((0.0, 0.03), (y[0], y[1]), (-tall, tall), wood),
            detail((0.0, 0.03), (-half, half), (z[0], z[1]), wood),
        ]
    inset = edge + mount_m
    parts.append(label((0.012, 0.015), (-half + inset, half - inset), (-tall + inset, tall - inset), canvas))
    return Piece(tuple(parts))
