"""What stands in a factory hall: machine tool, press, workbench, pallet rack, conveyor, high lamps."""

import numpy as np

from simulator.furniture.loads import load_on_pallet, pallet_parts
from simulator.furniture.stacks import any_colour
from simulator.scene.parts import Light, Material, Part, Piece, Rgb
from simulator.scene.shapes import around, box, detail, label, post

STEEL = Material("metal", (168, 172, 176), 4)
DARK = Material("metal", (58, 62, 66), 3)
YELLOW = Material("lacquer", (226, 178, 36), 3)
BLUE = Material("lacquer", (44, 84, 140), 2)


def machine_tool(rng: np.random.Generator, colour: Rgb = (206, 212, 208), width_m: float = 2.6) -> Piece:
    """Enclosed milling machine, its window and control panel towards +x."""
    y, paint = width_m / 2, Material("lacquer", colour, 5)
    parts: list[Part] = [
        box((-0.9, 0.8), (-y, y), (0.0, 0.25), DARK, tile_m=0.9),
        box((-0.9, 0.8), (-y, y), (0.25, 1.95), paint, tile_m=1.5),
        detail((-0.6, 0.3), (-0.5, 0.5), (1.95, 2.35), paint, tile_m=1.2),
        detail((0.8, 0.83), (-0.75, 0.45), (0.95, 1.7), Material("mirror", (70, 86, 96), 4)),
        detail((0.8, 0.86), (-0.8, -0.75), (0.9, 1.75), DARK),
        label((0.8, 0.84), (y - 0.7, y - 0.12), (1.05, 1.6), Material("panel", (60, 66, 72), 5)),
        label((0.8, 0.83), (-y + 0.1, -y + 0.45), (1.2, 1.65), Material("poster", (210, 60, 40), 3)),
        detail((0.8, 0.82), (-y, y), (0.72, 0.8), BLUE),
        post(-0.7, y - 0.2, (1.95, 2.5), 0.03, DARK, solid=False),
    ]
    for step, ink in enumerate(((40, 160, 80), (226, 178, 36), (196, 40, 36))):
        z = 2.5 + 0.09 * step
        parts.append(post(-0.7, y - 0.2, (z, z + 0.09), 0.04, Material("lacquer", ink, 1), solid=False))
    parts.append(_plate(-0.9, float(rng.uniform(-0.5, 0.5)), 1.3))
    return Piece.of(*parts)


def _plate(x: float, y: float, z: float) -> Part:
    """A rating plate on a back wall, facing -x."""
    plate = Material("panel", (232, 228, 214), 8)
    return label((x - 0.02, x), around(y, 0.2), around(z, 0.15), plate)


def press(rng: np.random.Generator, colour: Rgb = (86, 128, 96)) -> Piece:
    """A tall press on a bed: two columns, a crosshead, a ram, its work table towards +x."""
    del rng
    paint = Material("lacquer", colour, 2)
    parts: list[Part] = [
        box((-0.7, 0.7), (-0.9, 0.9), (0.0, 0.7), paint, tile_m=1.2),
        box((-0.45, 0.45), (-0.9, -0.55), (0.7, 2.9), paint, tile_m=1.2),
        box((-0.45, 0.45), (0.55, 0.9), (0.7, 2.9), paint, tile_m=1.2),
        detail((-0.5, 0.5), (-0.95, 0.95), (2.9, 3.5), paint, tile_m=1.2),
        post(0.0, 0.0, (1.8, 2.9), 0.2, STEEL, solid=False),
        detail((-0.35, 0.35), (-0.5, 0.5), (1.5, 1.8), DARK),
        detail((-0.4, 0.6), (-0.5, 0.5), (0.7, 0.85), STEEL),
        label((0.45, 0.48), (0.58, 0.86), (1.2, 1.7), Material("panel", (220, 220, 210), 3)),
    ]
    for low in np.arange(-0.9, 0.9, 0.3):
        stripe = YELLOW if round(low / 0.3) % 2 else DARK
        parts.append(detail((0.7, 0.715), (low, low + 0.3), (0.56, 0.7), stripe))
    return Piece.of(*parts)


def workbench(rng: np.random.Generator, length_m: float = 2.2) -> Piece:
    """Bench with drawers, a vice, tools on a pegboard; its back at x = 0."""
    y = length_m / 2
    parts: list[Part] = [
        box((0.0, 0.75), (-y, y), (0.84, 0.92), Material("planks", (168, 128, 84), 4), tile_m=1.0),
        box((0.05, 0.7), (-y + 0.05, -y + 0.65), (0.05, 0.84), BLUE, tile_m=0.8),
        box((0.05, 0.7), (y - 0.65, y - 0.05), (0.05, 0.84), BLUE, tile_m=0.8),
        box((0.0, 0.05), (-y, y), (0.0, 0.84), DARK),
        detail((0.0, 0.04), (-y, y), (1.0, 1.9), Material("panel", (186, 178, 158), 2), tile_m=1.4),
        detail((0.5, 0.72), (y - 0.45, y - 0.25), (0.92, 1.12), DARK),
    ]
    for _ in range(9):
        at, low, tall = rng.uniform(-y + 0.15, y - 0.15), rng.uniform(1.05, 1.45), rng.uniform(0.15, 0.4)
        ink = any_colour(rng, 30, 220)
        tool = Material("lacquer", ink, 1)
        parts.append(detail((0.04, 0.09), around(at, 0.03), (low, low + tall), tool))
    return Piece.of(*parts)


def pallet_rack(rng: np.random.Generator, bays: int = 2, levels: int = 3) -> Piece:
    """Rack for pallets, 2.7 m a bay along y, its back at x = 0, loads on every level."""
    depth, bay = 1.1, 2.7
    y = bays * bay / 2
    orange = Material("lacquer", (214, 104, 36), 2)
    frame = Material("lacquer", (40, 74, 126), 3)
    parts: list[Part] = []
    for k in range(bays + 1):
        for x in (0.05, depth - 0.05):
            at = -y + k * bay
            height = 1.5 * levels + 0.3
            parts.append(box(around(x, 0.05), around(at, 0.05), (0.0, height), frame, tile_m=0.8))
    for level in range(levels):
        z = 1.5 * level
        if level:
            for x in (0.05, depth - 0.05):
                parts.append(detail(around(x, 0.03), (-y, y), (z - 0.12, z), orange))
        for k in range(bays):
            for side in (-0.65, 0.65):
                at = -y + (k + 0.5) * bay + side
                parts += load_on_pallet(rng, (depth / 2, at, z), 1.2)
    return Piece.of(*parts)


def conveyor(rng: np.random.Generator, length_m: float = 5.0) -> Piece:
    """Belt along y between guides on a closed frame, with cartons on it."""
    y = length_m / 2
    parts: list[Part] = [
        box((-0.4, 0.4), (-y, y), (0.1, 0.6), Material("lacquer", (96, 108, 116), 4), tile_m=1.0),
        box((-0.34, 0.34), (-y, y), (0.6, 0.7), Material("fabric", (44, 46, 48), 2), tile_m=0.6),
        *(box(around(s * 0.4, 0.04), (-y, y), (0.6, 0.8), YELLOW, tile_m=0.8) for s in (-1, 1)),
    ]
    at = -y + 0.4
    while at < y - 0.4:
        tall = float(rng.uniform(0.22, 0.42))
        ink = Material("poster" if rng.random() < 0.3 else "planks", (186, 146, 100), int(rng.integers(6)))
        parts.append(detail((-0.22, 0.22), (at, at + 0.4), (0.7, 0.7 + tall), ink, tile_m=0.4))
        at += float(rng.uniform(0.7, 1.3))
    return Piece.of(*parts)


def hall_lamp(rng: np.random.Generator, strength: float = 14.0) -> Piece:
    """A bell lamp on a rod; the item's height is that of the ceiling."""
    del rng
    shade = Material("glow", (255, 250, 238), 1, glow=1.0)
    parts = (
        post(0.0, 0.0, (-0.7, 0.0), 0.02, DARK, solid=False, casts_shadow=False),
        post(0.0, 0.0, (-0.95, -0.7), 0.34, STEEL, solid=False, casts_shadow=False, taper=0.35),
        post(0.0, 0.0, (-0.99, -0.95), 0.3, shade, solid=False, casts_shadow=False),
    )
    power = (strength, 0.97 * strength, 0.9 * strength)
    return Piece(parts, (Light((0.0, 0.0, -1.05), (0.3, 0.3, 0.02), power),))


def bollard(rng: np.random.Generator) -> Piece:
    """A striped post that guards a corner."""
    del rng
    bands = [post(0.0, 0.0, (0.2 * k, 0.2 * k + 0.2), 0.09, (YELLOW, DARK)[k % 2]) for k in range(5)]
    return Piece(tuple(bands))


def floor_mark(rng: np.random.Generator, length_m: float = 6.0, width_m: float = 0.12) -> Piece:
    """A painted line along y."""
    del rng
    paint = Material("lacquer", (224, 184, 60), 6)
    mark = detail(
        (-width_m / 2, width_m / 2), (-length_m / 2, length_m / 2), (0.0, 0.004), paint, casts_shadow=False
    )
    return Piece.of(mark)


def pallet_pile(rng: np.random.Generator, count: int = 9) -> Piece:
    """Empty pallets on one another, not quite flush."""
    parts: list[Part] = []
    for k in range(count):
        shift = rng.uniform(-0.03, 0.03, 2)
        parts += pallet_parts((float(shift[0]), float(shift[1]), 0.145 * k))
    return Piece.of(*parts)
