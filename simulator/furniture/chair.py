"""Wooden chair with a seat cushion."""

import numpy as np

from simulator.scene.parts import Material, Piece, Rgb, box, rounded


def chair(rng: np.random.Generator, colour: Rgb = (150, 106, 66), cushion: Rgb = (182, 84, 62)) -> Piece:
    """Chair facing +x; 0.42 m wide, 0.44 m deep."""
    wood = Material("wood", colour, int(rng.integers(3)))
    cloth = Material("fabric", cushion, int(rng.integers(3)))
    parts = [
        box((-0.2, 0.22), (-0.21, 0.21), (0.42, 0.45), wood),
        rounded((0.02, 0.0, 0.47), (0.38, 0.38, 0.05), cloth, solid=False, tile_m=0.4),
    ]
    for y in (-0.19, 0.19):
        parts += [
            box((0.17, 0.21), (y - 0.02, y + 0.02), (0.0, 0.42), wood),
            box((-0.22, -0.18), (y - 0.02, y + 0.02), (0.0, 0.95), wood),
        ]
    for low, high in ((0.55, 0.6), (0.68, 0.74), (0.84, 0.95)):
        parts.append(box((-0.215, -0.185), (-0.17, 0.17), (low, high), wood))
    return Piece(tuple(parts))
