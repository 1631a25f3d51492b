"""Dining table laid with a runner, plates, a bowl of fruit and a vase."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb, ball, box, detail, post


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
    parts.extend(
        box((sx * (hw - 0.1), sx * (hw - 0.03)), (sy * (hl - 0.1), sy * (hl - 0.03)), (0.0, top - 0.035), oak)
        for sx in (-1, 1)
        for sy in (-1, 1)
    )
    runner = Material("pattern_cloth", (224, 214, 196), int(rng.integers(3)))
    parts.append(detail((-0.2, 0.2), (-hl + 0.12, hl - 0.12), (top, top + 0.004), runner, tile_m=0.5))
    china = Material("ceramic", (228, 226, 220), int(rng.integers(3)))
    blue = Material("ceramic", (70, 104, 142), int(rng.integers(3)))
    for sx in (-1, 1):
        for y in (-0.45, 0.45):
            parts += [
                post(sx * (hw - 0.2), y, (top, top + 0.015), 0.13, china, solid=False, tile_m=0.2),
                post(
                    sx * (hw - 0.2) + 0.02, y + 0.21, (top, top + 0.11), 0.035, blue, solid=False, tile_m=0.2
                ),
            ]
    parts.append(post(0.0, -0.1, (top, top + 0.09), 0.12, blue, solid=False, taper=1.5, tile_m=0.3))
    for k in range(7):
        angle, radius = k * 2 * np.pi / 6, 0.0 if k == 6 else 0.085
        fruit = Material("ceramic", ((206, 84, 44), (222, 176, 60), (140, 160, 70))[k % 3], k)
        parts.append(
            ball(
                (radius * np.cos(angle), -0.1 + radius * np.sin(angle), top + 0.11),
                (0.075, 0.075, 0.07),
                fruit,
                tile_m=0.1,
            )
        )
    parts.extend(_bouquet(rng, 0.0, 0.35, top))
    return Piece(tuple(parts))


def _bouquet(rng: np.random.Generator, x: float, y: float, z: float) -> list[Part]:
    vase = Material("ceramic", (196, 120, 86), int(rng.integers(3)))
    parts = [post(x, y, (z, z + 0.2), 0.05, vase, solid=False, taper=0.7, tile_m=0.3)]
    for _ in range(16):
        dx, dy, dz = rng.normal(0, 0.055, 3)
        colour: Rgb = ((214, 70, 86), (238, 206, 96), (246, 240, 236), (166, 96, 160))[int(rng.integers(4))]
        bloom = Material("fabric", colour, int(rng.integers(9)))
        parts.append(ball((x + dx, y + dy, z + 0.31 + dz), (0.05, 0.05, 0.04), bloom, tile_m=0.1))
    green = Material("leaf", (78, 116, 58), 1)
    parts.extend(
        Part(
            "leaf",
            (x, y, z + 0.24),
            (0.22, 0.06, 0.05),
            green,
            yaw_rad=float(a),
            pitch_rad=-0.9,
            solid=False,
            tile_m=None,
        )
        for a in rng.uniform(0, 6.28, 7)
    )
    return parts
