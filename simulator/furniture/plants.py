"""What grows: trees, hedges, flower beds, and a plant in its pot."""

from dataclasses import replace

import numpy as np

from simulator.furniture.stacks import shade_of
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import ball, box, detail, post
from simulator.textures.noise import one_of


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
        green = Material("foliage", shade_of(rng, leaf, 16), int(rng.integers(2)))
        centre = (out * np.cos(angle), out * np.sin(angle), z)
        parts.append(ball(centre, (size, size, size * 0.8), green, yaw_rad=angle, tile_m=1.1))
    return Piece.of(*parts)


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
    return Piece.of(*parts)


def flower_bed(rng: np.random.Generator, length_m: float = 2.0, width_m: float = 1.0) -> Piece:
    """Earth in a stone frame with flowers."""
    stone, earth = Material("concrete", (170, 164, 152), 8), Material("bark", (86, 66, 50), 9)
    x, y, green = length_m / 2, width_m / 2, Material("foliage", (80, 116, 58), 0)
    parts: list[Part] = [
        box((-x, x), (-y, y), (0.0, 0.2), stone, tile_m=0.8),
        detail((-x + 0.08, x - 0.08), (-y + 0.08, y - 0.08), (0.2, 0.24), earth, tile_m=0.7),
    ]
    inks: tuple[Rgb, ...] = ((206, 48, 62), (232, 192, 52), (236, 234, 240), (150, 74, 168), (226, 120, 60))
    for _ in range(int(14 * length_m * width_m)):
        at = rng.uniform((-x + 0.15, -y + 0.15), (x - 0.15, y - 0.15))
        tall, size = float(rng.uniform(0.3, 0.5)), float(rng.uniform(0.1, 0.18))
        bloom, where = Material("lacquer", one_of(rng, inks), 1), (float(at[0]), float(at[1]))
        parts += [
            ball((*where, tall - 0.08), (0.22, 0.22, 0.16), green, tile_m=0.5),
            ball((*where, tall), (size, size, size * 0.6), bloom, tile_m=0.3),
        ]
    return Piece.of(*parts)


def plant(
    rng: np.random.Generator,
    height_m: float = 1.2,
    pot_radius_m: float = 0.17,
    pot: Rgb = (176, 104, 74),
    leaf: Rgb = (62, 104, 50),
    leaves: int = 34,
) -> Piece:
    """Plant in a pot; leaves spread wider than the pot only above the robot."""
    clay = Material("ceramic", pot, int(rng.integers(3)))
    stem = Material("wood", (96, 78, 52), 2)
    parts: list[Part] = [
        post(0.0, 0.0, (0.0, 0.32), pot_radius_m, clay, taper=1.15, tile_m=0.4),
        post(0.0, 0.0, (0.32, height_m * 0.8), 0.015, stem, solid=False),
    ]
    for _ in range(leaves):
        z = float(rng.uniform(0.4, height_m))
        reach = float(rng.uniform(0.22, 0.4)) * (0.55 if z < 0.8 else 1.0)
        yaw, lift = float(rng.uniform(0, 2 * np.pi)), float(rng.uniform(-0.9, 0.1))
        green = Material("leaf", shade_of(rng, leaf, 32), 0)
        centre = (
            reach / 2 * np.cos(yaw) * np.cos(lift),
            reach / 2 * np.sin(yaw) * np.cos(lift),
            z - reach / 2 * np.sin(lift),
        )
        blade = Part("leaf", centre, (reach, reach * 0.36, reach * 0.2), green, solid=False, tile_m=None)
        parts.append(replace(blade, yaw_rad=yaw, pitch_rad=lift))
    return Piece.of(*parts)
