"""A dining table laid with a runner, plates, fruit and a vase, and its chairs."""

from dataclasses import replace

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import around, ball, box, detail, post, rounded, table_legs
from simulator.textures.noise import one_of


def dining_table(
    rng: np.random.Generator,
    length_m: float = 1.8,
    width_m: float = 1.0,
    height_m: float = 0.75,
    colour: Rgb = (168, 122, 78),
) -> Piece:
    """Table with its long side along y."""
    oak = Material("wood", colour, int(rng.integers(3)))
    hw, hl = width_m / 2, length_m / 2
    top = height_m
    parts = [
        box((-hw, hw), (-hl, hl), (top - 0.035, top), oak, tile_m=0.9),
        box((-hw + 0.06, hw - 0.06), (-hl + 0.06, hl - 0.06), (top - 0.11, top - 0.035), oak),
    ]
    parts += table_legs((hw - 0.1, hw - 0.03), (hl - 0.1, hl - 0.03), (0.0, top - 0.035), oak)
    runner = Material("pattern_cloth", (224, 214, 196), int(rng.integers(3)))
    parts.append(detail((-0.2, 0.2), (-hl + 0.12, hl - 0.12), (top, top + 0.004), runner, tile_m=0.5))
    china = Material("ceramic", (228, 226, 220), int(rng.integers(3)))
    blue = Material("ceramic", (70, 104, 142), int(rng.integers(3)))
    for x in (-(hw - 0.2), hw - 0.2):
        for y in (-0.45, 0.45):
            plate = post(x, y, (top, top + 0.015), 0.13, china, solid=False, tile_m=0.2)
            cup = post(x + 0.02, y + 0.21, (top, top + 0.11), 0.035, blue, solid=False, tile_m=0.2)
            parts += [plate, cup]
    parts.append(post(0.0, -0.1, (top, top + 0.09), 0.12, blue, solid=False, taper=1.5, tile_m=0.3))
    for k in range(7):
        angle, radius = k * 2 * np.pi / 6, 0.0 if k == 6 else 0.085
        fruit = Material("ceramic", ((206, 84, 44), (222, 176, 60), (140, 160, 70))[k % 3], k)
        centre = (radius * np.cos(angle), -0.1 + radius * np.sin(angle), top + 0.11)
        parts.append(ball(centre, (0.075, 0.075, 0.07), fruit, tile_m=0.1))
    parts.extend(_bouquet(rng, 0.0, 0.35, top))
    return Piece.of(*parts)


def _bouquet(rng: np.random.Generator, x: float, y: float, z: float) -> list[Part]:
    vase = Material("ceramic", (196, 120, 86), int(rng.integers(3)))
    parts = [post(x, y, (z, z + 0.2), 0.05, vase, solid=False, taper=0.7, tile_m=0.3)]
    for _ in range(16):
        dx, dy, dz = rng.normal(0, 0.055, 3)
        colour: Rgb = one_of(rng, ((214, 70, 86), (238, 206, 96), (246, 240, 236), (166, 96, 160)))
        bloom = Material("fabric", colour, int(rng.integers(9)))
        parts.append(ball((x + dx, y + dy, z + 0.31 + dz), (0.05, 0.05, 0.04), bloom, tile_m=0.1))
    green = Material("leaf", (78, 116, 58), 1)
    blade = Part(
        "leaf", (x, y, z + 0.24), (0.22, 0.06, 0.05), green, solid=False, tile_m=None, pitch_rad=-0.9
    )
    return parts + [replace(blade, yaw_rad=float(angle)) for angle in rng.uniform(0, 6.28, 7)]


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
            box((0.17, 0.21), around(y, 0.02), (0.0, 0.42), wood),
            box((-0.22, -0.18), around(y, 0.02), (0.0, 0.95), wood),
        ]
    for low, high in ((0.55, 0.6), (0.68, 0.74), (0.84, 0.95)):
        parts.append(box((-0.215, -0.185), (-0.17, 0.17), (low, high), wood))
    return Piece.of(*parts)
