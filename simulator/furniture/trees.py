"""What grows: trees and hedges."""

import numpy as np

from simulator.furniture.stacks import shade_of
from simulator.scene.parts import Material, Part, Piece, Rgb, ball, box, detail, post


def tree(
    rng: np.random.Generator,
    height_m: float = 6.0,
    trunk_m: float = 0.3,
    crown_m: float = 3.4,
    leaf: Rgb = (96, 132, 62),
) -> Piece:
    """Trunk with a few boughs and a crown of many tufts, higher than the robot."""
    bark = Material("bark", (112, 92, 72), int(rng.integers(4)))
    low = height_m * 0.36
    parts: list[Part] = [
        post(0.0, 0.0, (0.0, height_m * 0.62), trunk_m / 2, bark, taper=0.6, tile_m=0.8),
        post(0.0, 0.0, (0.0, 0.25), trunk_m * 0.75, bark, taper=0.6, tile_m=0.8, solid=False),
    ]
    for _ in range(22):
        angle, out = float(rng.uniform(0, 2 * np.pi)), crown_m / 2 * float(rng.uniform(0.1, 0.8))
        z = low + (height_m - low) * float(rng.uniform(0.12, 0.9))
        size = crown_m * float(rng.uniform(0.3, 0.5)) * (1.15 - abs(z - (low + height_m) / 2) / height_m)
        tone = shade_of(rng, leaf, 16)
        parts.append(
            ball(
                (out * np.cos(angle), out * np.sin(angle), z),
                (size, size, size * 0.8),
                Material("foliage", tone, int(rng.integers(2))),
                yaw_rad=angle,
                tile_m=1.1,
            )
        )
    return Piece(tuple(parts))


def hedge(
    rng: np.random.Generator,
    length_m: float = 4.0,
    height_m: float = 1.0,
    depth_m: float = 0.7,
    leaf: Rgb = (72, 104, 52),
) -> Piece:
    """A clipped hedge along y: a solid core with a wavy coat."""
    green = Material("foliage", leaf, 3)
    parts: list[Part] = [
        box((-depth_m / 2, depth_m / 2), (-length_m / 2, length_m / 2), (0.0, height_m), green, tile_m=1.2)
    ]
    for at in np.arange(-length_m / 2 + 0.3, length_m / 2 - 0.2, 0.45):
        size = float(rng.uniform(0.5, 0.75))
        centre = (float(rng.uniform(-0.12, 0.12)), float(at), height_m - 0.06)
        parts.append(ball(centre, (depth_m * 1.02, size, 0.4), green, tile_m=0.9))
    return Piece(tuple(parts))


def flower_bed(rng: np.random.Generator, length_m: float = 2.0, width_m: float = 1.0) -> Piece:
    """Earth in a stone frame with flowers."""
    stone, earth = Material("concrete", (170, 164, 152), 8), Material("bark", (86, 66, 50), 9)
    x, y = length_m / 2, width_m / 2
    parts: list[Part] = [
        box((-x, x), (-y, y), (0.0, 0.2), stone, tile_m=0.8),
        detail((-x + 0.08, x - 0.08), (-y + 0.08, y - 0.08), (0.2, 0.24), earth, tile_m=0.7),
    ]
    inks: tuple[Rgb, ...] = ((206, 48, 62), (232, 192, 52), (236, 234, 240), (150, 74, 168), (226, 120, 60))
    for _ in range(int(14 * length_m * width_m)):
        at = rng.uniform((-x + 0.15, -y + 0.15), (x - 0.15, y - 0.15))
        tall, size = float(rng.uniform(0.3, 0.5)), float(rng.uniform(0.1, 0.18))
        ink = inks[int(rng.integers(len(inks)))]
        centre = (float(at[0]), float(at[1]), tall)
        parts += [
            ball(
                (centre[0], centre[1], tall - 0.08),
                (0.22, 0.22, 0.16),
                Material("foliage", (80, 116, 58), 0),
                tile_m=0.5,
            ),
            ball(centre, (size, size, size * 0.6), Material("lacquer", ink, 1), tile_m=0.3),
        ]
    return Piece(tuple(parts))
