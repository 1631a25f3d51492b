"""Pallets and what stands on them. They fill the floor under them: nothing drives below."""

import numpy as np

from simulator.scene.parts import Material, Part, Piece, Rgb, Vec3
from simulator.scene.shapes import around, box, detail, label, post, rounded
from simulator.textures.noise import one_of

WOOD = Material("planks", (176, 138, 92), 6)
TAPE = Material("lacquer", (214, 196, 150), 2)
CARTON: tuple[Rgb, ...] = ((190, 150, 104), (176, 132, 86), (202, 168, 122))
INKS: tuple[Rgb, ...] = ((44, 84, 140), (166, 44, 40), (52, 110, 76), (60, 62, 66), (206, 160, 44))
HALF_X_M, HALF_Y_M = 0.42, 0.58
DECK_M = 0.145


def pallet_parts(at: Vec3) -> list[Part]:
    """One flat pallet: boards over three runners, with dark gaps between."""
    x, y, z = at
    gap = Material("fabric", (52, 44, 38), 1)
    inner = (x - HALF_X_M + 0.02, x + HALF_X_M - 0.02), (y - HALF_Y_M + 0.02, y + HALF_Y_M - 0.02)
    parts = [box(*inner, (z, z + 0.11), gap, tile_m=0.6)]
    for side in (-1.0, 0.0, 1.0):
        low = y + side * (HALF_Y_M - 0.06)
        parts.append(box(around(x, HALF_X_M), around(low, 0.06), (z, z + 0.11), WOOD))
    parts.append(box(around(x, HALF_X_M), around(y, HALF_Y_M), (z + 0.11, z + DECK_M), WOOD))
    return parts


def load_on_pallet(rng: np.random.Generator, at: Vec3, most_m: float) -> list[Part]:
    """A pallet with cartons, sacks or drums, at most `most_m` high."""
    parts = pallet_parts(at)
    style = rng.random()
    x, y, z = at[0], at[1], at[2] + DECK_M
    if style < 0.6:
        return parts + _cartons(rng, (x, y, z), most_m - DECK_M)
    if style < 0.8:
        return parts + _drums(rng, (x, y, z), min(0.88, most_m - DECK_M))
    return parts + _sacks(rng, (x, y, z), most_m - DECK_M)


def _cartons(rng: np.random.Generator, at: Vec3, room_m: float) -> list[Part]:
    x, y, z = at
    parts: list[Part] = []
    tall = float(rng.uniform(0.26, 0.38))
    for layer in range(int(room_m * rng.uniform(0.65, 1.0) / tall)):
        for kx in (-1, 1):
            for ky in (-1, 0, 1):
                if layer > 1 and rng.random() < 0.12:
                    continue
                ink = one_of(rng, CARTON)
                look = Material("poster" if rng.random() < 0.12 else "planks", ink, int(rng.integers(5)))
                cx, cy = x + kx * 0.2, y + ky * 0.375
                low, high = z + layer * tall, z + (layer + 1) * tall
                parts += [
                    box(around(cx, 0.195), around(cy, 0.18), (low, high - 0.01), look, tile_m=0.5),
                    detail(
                        around(cx, 0.197), around(cy, 0.03), (low, high - 0.008), TAPE, casts_shadow=False
                    ),
                ]
    return parts


def _drums(rng: np.random.Generator, at: Vec3, tall: float) -> list[Part]:
    x, y, z = at
    look = Material("metal", one_of(rng, INKS), 4)
    parts: list[Part] = []
    for kx in (-0.21, 0.21):
        for ky in (-0.29, 0.29):
            parts.append(post(x + kx, y + ky, (z, z + tall), 0.2, look, tile_m=0.6))
            for ring in (0.33, 0.66):
                level = z + ring * tall
                parts.append(post(x + kx, y + ky, (level, level + 0.03), 0.21, look, solid=False))
    return parts


def _sacks(rng: np.random.Generator, at: Vec3, room_m: float) -> list[Part]:
    x, y, z = at
    cloth = Material("fabric", (206, 196, 170), int(rng.integers(4)))
    parts = [box(around(x, 0.36), around(y, 0.5), (z, z + 0.1), cloth)]
    for layer in range(max(1, int(room_m * 0.7 / 0.17))):
        for ky in (-0.36, 0.0, 0.36):
            shift = float(rng.uniform(-0.04, 0.04))
            centre = (x + shift, y + ky, z + 0.09 + 0.17 * layer)
            parts.append(rounded(centre, (0.78, 0.4, 0.19), cloth, solid=False, tile_m=0.7))
    return parts


def pallet_stack(rng: np.random.Generator, height_m: float = 1.4) -> Piece:
    """A loaded pallet, long side along y."""
    return Piece(tuple(load_on_pallet(rng, (0.0, 0.0, 0.0), height_m)))


def drums(rng: np.random.Generator, count: int = 5) -> Piece:
    """Oil drums standing close together."""
    parts: list[Part] = []
    for k in range(count):
        x, y = 0.62 * (k % 2) - 0.3, 0.62 * (k // 2) - 0.62 * ((count - 1) // 2) / 2
        look = Material("metal", one_of(rng, INKS), int(rng.integers(4)))
        parts.append(post(x, y, (0.0, 0.88), 0.29, look, tile_m=0.7))
        parts += [post(x, y, (z, z + 0.03), 0.3, look, solid=False) for z in (0.28, 0.57)]
        parts.append(post(x + 0.12, y, (0.88, 0.91), 0.04, Material("metal", (60, 62, 64), 2), solid=False))
    return Piece.of(*parts)


def container(rng: np.random.Generator, length_m: float = 6.0, colour: Rgb = (150, 62, 46)) -> Piece:
    """Freight container of fluted steel, its doors towards +x, long side along x."""
    x, y, height = length_m / 2, 1.22, 2.55
    steel = Material("radiator", colour, 2)
    rail = Material("metal", tuple(int(c * 0.8) for c in colour), 2)  # type: ignore[arg-type]
    parts: list[Part] = [
        box((-x, x), (-y, y), (0.0, 0.16), rail, tile_m=1.2),
        box((-x + 0.03, x - 0.03), (-y + 0.03, y - 0.03), (0.16, height), steel, tile_m=1.3),
        *(
            box(around(sx * x, 0.09), around(sy * y, 0.09), (0.0, height), rail)
            for sx in (-1, 1)
            for sy in (-1, 1)
        ),
        *(detail((-x, x), around(s * y, 0.04), (height - 0.12, height), rail) for s in (-1, 1)),
    ]
    for at in (-0.75, -0.3, 0.3, 0.75):
        parts.append(
            post(x + 0.03, at, (0.2, height - 0.1), 0.025, Material("metal", (186, 188, 190), 3), solid=False)
        )
    for side in (-1.0, 1.0):
        sign = Material("poster", one_of(rng, INKS), int(rng.integers(9)))
        parts.append(label((x - 1.9, x - 0.6), (side * y, side * (y + 0.012)), (1.5, 2.2), sign))
    return Piece.of(*parts)
