"""A kitchen for breaks: counter with sink and coffee machine, fridge, vending machine, water cooler."""

import numpy as np

from simulator.furniture.stacks import any_colour
from simulator.scene.parts import Material, Part, Piece, Rgb
from simulator.scene.shapes import box, detail, label, post

STEEL = Material("metal", (186, 188, 190), 3)
DARK = Material("lacquer", (38, 40, 44), 2)
WHITE = Material("lacquer", (236, 236, 232), 4)


def kitchen_counter(rng: np.random.Generator, length_m: float = 3.0, colour: Rgb = (92, 124, 132)) -> Piece:
    """Cupboards along y under a worktop with sink, coffee machine and mugs; wall cupboards above."""
    front, top = Material("lacquer", colour, 5), Material("wood", (176, 140, 100), 1)
    half, parts = length_m / 2, []
    parts += [
        box((0.0, 0.56), (-half, half), (0.1, 0.86), front, tile_m=1.0),
        box((0.04, 0.5), (-half, half), (0.0, 0.1), DARK),
        box((0.0, 0.6), (-half, half), (0.86, 0.9), top, tile_m=1.4),
        detail((0.0, 0.02), (-half, half), (0.9, 1.4), Material("tiles", (226, 222, 210), 7), tile_m=1.2),
        detail((0.0, 0.34), (-half, half), (1.45, 2.15), WHITE, tile_m=1.1),
    ]
    for k in range(round(length_m / 0.6)):
        y = -half + 0.6 * k
        parts += [
            detail((0.56, 0.575), (y + 0.24, y + 0.36), (0.74, 0.76), STEEL),
            detail((0.34, 0.35), (y + 0.0, y + 0.008), (1.45, 2.15), DARK),
            detail((0.56, 0.566), (y + 0.0, y + 0.01), (0.12, 0.84), DARK),
        ]
    parts += [
        detail((0.12, 0.48), (-half + 0.3, -half + 0.8), (0.895, 0.905), STEEL),
        post(0.08, -half + 0.55, (0.9, 1.18), 0.018, STEEL, solid=False),
        detail((0.08, 0.26), (-half + 0.53, -half + 0.57), (1.16, 1.2), STEEL),
        detail((0.08, 0.44), (0.0, 0.34), (0.9, 1.3), DARK),
        label((0.44, 0.445), (0.05, 0.29), (1.12, 1.26), Material("panel", (120, 124, 130), 3)),
        detail((0.06, 0.44), (0.55, 1.05), (0.9, 1.2), STEEL),
        label((0.44, 0.445), (0.58, 0.9), (0.94, 1.16), Material("screen", (30, 32, 38), 5)),
    ]
    for _ in range(9):
        ink = any_colour(rng, 40, 230)
        x, y = float(rng.uniform(0.12, 0.45)), float(rng.uniform(-half + 0.9, -0.1))
        parts.append(post(x, y, (0.9, 1.0), 0.04, Material("ceramic", ink, 1), solid=False, tile_m=0.3))
    return Piece.of(*parts)


def fridge(rng: np.random.Generator, height_m: float = 1.85, colour: Rgb = (214, 216, 216)) -> Piece:
    """Fridge with a freezer, notes and magnets on its door; back against x = 0."""
    skin, parts = Material("metal", colour, 2), []
    parts += [
        box((0.0, 0.62), (-0.3, 0.3), (0.02, height_m), skin, tile_m=1.3),
        detail((0.62, 0.626), (-0.3, 0.3), (height_m * 0.35, height_m * 0.36), DARK),
    ]
    for z in (height_m * 0.28, height_m * 0.55):
        parts.append(detail((0.62, 0.66), (0.22, 0.25), (z - 0.1, z + 0.14), STEEL))
    for k in range(7):
        y, z = float(rng.uniform(-0.24, 0.1)), float(rng.uniform(0.8, height_m - 0.2))
        note = Material("poster" if k % 2 else "panel", (236, 220, 120), int(rng.integers(9)))
        size = float(rng.uniform(0.05, 0.1))
        parts.append(label((0.62, 0.624), (y, y + size), (z, z + size * 1.2), note))
    return Piece.of(*parts)


def vending_machine(rng: np.random.Generator, colour: Rgb = (176, 34, 40)) -> Piece:
    """Snacks behind glass, a keypad and a slot; back against x = 0."""
    skin, parts = Material("lacquer", colour, 3), []
    parts += [
        box((0.0, 0.72), (-0.5, 0.5), (0.03, 1.85), skin, tile_m=1.3),
        detail((0.72, 0.725), (-0.44, 0.2), (0.6, 1.72), DARK),
    ]
    for row in range(5):
        z = 0.66 + 0.21 * row
        parts.append(detail((0.725, 0.735), (-0.42, 0.18), (z - 0.02, z), STEEL))
        for place in range(6):
            ink = any_colour(rng, 30, 240)
            y, tall = -0.41 + 0.098 * place, float(rng.uniform(0.1, 0.17))
            pack = Material("pattern_cloth", ink, int(rng.integers(3)))
            parts.append(detail((0.725, 0.74), (y, y + 0.08), (z, z + tall), pack, tile_m=0.2))
    parts += [
        label((0.72, 0.73), (0.26, 0.44), (1.1, 1.4), Material("panel", (70, 74, 80), 8)),
        detail((0.72, 0.73), (-0.36, 0.12), (0.2, 0.42), DARK),
        label((0.72, 0.725), (-0.46, 0.46), (1.74, 1.83), Material("poster", (240, 240, 240), 4)),
    ]
    return Piece.of(*parts)


def water_cooler(rng: np.random.Generator) -> Piece:
    """A bottle upside down on a stand."""
    del rng
    blue = Material("view", (120, 170, 206), 2)
    parts: list[Part] = [
        box((-0.16, 0.16), (-0.16, 0.16), (0.0, 0.95), WHITE, tile_m=0.8),
        detail((0.16, 0.2), (-0.1, 0.1), (0.72, 0.76), STEEL),
        label((0.16, 0.165), (-0.12, 0.12), (0.55, 0.9), Material("panel", (190, 196, 200), 6)),
        post(0.0, 0.0, (0.95, 1.35), 0.135, blue, solid=False, tile_m=0.6),
    ]
    return Piece.of(*parts)
