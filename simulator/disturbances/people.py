"""How walkers look and what of them is solid: persons and carts, in their own frame, x forward. Pure."""

from dataclasses import dataclass

import numpy as np

from simulator.scene.parts import Material, Part, Rgb
from simulator.scene.shapes import box, post, rounded
from simulator.textures.noise import one_of

SKIN: tuple[Rgb, ...] = ((224, 184, 156), (188, 140, 108), (120, 84, 62))
CLOTHES: tuple[Rgb, ...] = ((172, 52, 44), (44, 92, 152), (64, 122, 74), (196, 160, 60), (96, 66, 120))
TROUSERS: tuple[Rgb, ...] = ((46, 52, 74), (84, 76, 66), (40, 40, 44))
HAIR: tuple[Rgb, ...] = ((48, 36, 28), (140, 100, 56), (70, 70, 72))
UNSEEN = Material("lacquer", (0, 0, 0))


@dataclass(frozen=True)
class Figure:
    """Something that walks.

    Attributes:
        looks: what the camera sees.
        solid: the one box or upright cylinder that sonar feels and the robot hits; never drawn.
        radius_m: of the disc on the floor that holds it in every direction.
        speed_mps: when nothing is in its way.
    """

    looks: tuple[Part, ...]
    solid: Part
    radius_m: float
    speed_mps: float


def person(rng: np.random.Generator) -> Figure:
    """A person in mid-stride: shoes, legs, torso, arms, head and hair."""
    skin = Material("lacquer", one_of(rng, SKIN), 41)
    shirt = Material("pattern_cloth", one_of(rng, CLOTHES), int(rng.integers(1000)))
    legs = Material("fabric", one_of(rng, TROUSERS), 42)
    shoe, hair = Material("lacquer", (36, 32, 30), 43), Material("fabric", one_of(rng, HAIR), 44)
    parts = []
    for side, ahead in ((1, 0.1), (-1, -0.1)):
        parts += [
            rounded((ahead + 0.05, side * 0.09, 0.04), (0.27, 0.1, 0.08), shoe),
            post(ahead * 0.8, side * 0.09, (0.06, 0.46), 0.055, legs, taper=1.2),
            post(ahead * 0.3, side * 0.09, (0.44, 0.88), 0.075, legs, taper=1.1),
            post(-ahead * 0.6, side * 0.235, (0.82, 1.1), 0.038, skin),
            post(-ahead * 0.3, side * 0.225, (1.08, 1.42), 0.052, shirt),
            Part("ellipsoid", (-ahead * 0.7, side * 0.235, 0.8), (0.09, 0.06, 0.13), skin),
        ]
    parts += [
        rounded((0.0, 0.0, 0.95), (0.23, 0.36, 0.22), legs),
        rounded((0.0, 0.0, 1.22), (0.25, 0.42, 0.5), shirt),
        post(0.0, 0.0, (1.44, 1.54), 0.055, skin),
        Part("ellipsoid", (0.01, 0.0, 1.64), (0.2, 0.165, 0.25), skin),
        Part("ellipsoid", (-0.02, 0.0, 1.69), (0.21, 0.18, 0.19), hair),
        Part("ellipsoid", (0.115, 0.0, 1.63), (0.03, 0.03, 0.05), skin),
    ]
    return Figure(
        tuple(parts), post(0.0, 0.0, (0.03, 1.75), 0.24, UNSEEN), 0.26, float(rng.uniform(0.4, 0.7))
    )


def cart(rng: np.random.Generator) -> Figure:
    """A driverless trolley with two boxes as load and a handle."""
    steel, rubber = Material("metal", (150, 154, 160), 45), Material("lacquer", (34, 34, 36), 46)
    deck = Material("lacquer", one_of(rng, CLOTHES), 47)
    card = Material("wood", (186, 148, 104), int(rng.integers(1000)))
    half_x, half_y = 0.36, 0.24
    parts = [
        box((-half_x, half_x), (-half_y, half_y), (0.14, 0.2), deck),
        box((-half_x + 0.04, 0.02), (-0.18, 0.18), (0.2, 0.46), card),
        box((0.05, half_x - 0.04), (-0.14, 0.16), (0.2, 0.38), card),
        box((-half_x, -half_x + 0.03), (-half_y, half_y), (0.86, 0.89), steel),
    ]
    parts += [
        post(sx * (half_x - 0.06), sy * (half_y - 0.04), (0.0, 0.14), 0.05, rubber)
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
    parts += [post(-half_x + 0.015, sy * (half_y - 0.02), (0.2, 0.88), 0.014, steel) for sy in (-1, 1)]
    solid = box((-half_x, half_x), (-half_y, half_y), (0.03, 0.9), UNSEEN)
    return Figure(tuple(parts), solid, float(np.hypot(half_x, half_y)), float(rng.uniform(0.3, 0.5)))
