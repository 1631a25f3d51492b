"""Colours and textures that go together: of floors, walls and furniture of one world. Pure."""

from dataclasses import dataclass
from typing import Any

import numpy as np

Colour = list[int]

WOODS: tuple[Colour, ...] = ([176, 132, 92], [150, 112, 76], [196, 164, 122], [124, 88, 56], [206, 190, 168])
CLOTHS: tuple[Colour, ...] = (
    [92, 112, 126],
    [150, 66, 52],
    [84, 112, 92],
    [176, 152, 112],
    [70, 84, 120],
    [128, 104, 66],
)
WALLS: tuple[Colour, ...] = (
    [232, 224, 208],
    [206, 214, 204],
    [222, 214, 196],
    [226, 226, 214],
    [214, 206, 214],
    [200, 210, 220],
)
FLOORS: tuple[tuple[str, Colour, float], ...] = (
    ("boards", [176, 132, 92], 3.6),
    ("boards", [150, 108, 74], 4.8),
    ("tiles", [196, 182, 162], 2.6),
    ("carpet_tile", [112, 74, 66], 0.6),
    ("carpet_tile", [92, 100, 108], 0.6),
    ("carpet_tile", [104, 110, 84], 0.6),
    ("planks", [168, 140, 108], 4.0),
)
HARD_FLOORS: tuple[tuple[str, Colour, float], ...] = (
    ("concrete", [150, 152, 150], 5.0),
    ("tiles", [184, 186, 184], 3.0),
    ("concrete", [168, 164, 156], 4.0),
)


GROUNDS: dict[str, dict[str, Any]] = {
    "street": {"texture": "asphalt", "colour": [112, 112, 114], "tile_m": 7.0},
    "yard": {"texture": "asphalt", "colour": [118, 118, 116], "tile_m": 7.0},
    "garden": {"texture": "grass", "colour": [98, 126, 66], "tile_m": 6.0},
}
"""By the first word of a use."""


@dataclass(frozen=True)
class Palette:
    """What one world is made of.

    Attributes:
        wood: of its furniture.
        cloths: of seats, blankets and curtains.
        rng: draws what is taken from it.
        hard: floors and walls of halls.
    """

    wood: Colour
    cloths: tuple[Colour, ...]
    rng: np.random.Generator
    hard: bool

    def cloth(self) -> Colour:
        """One of them, drawn."""
        return list(self.cloths[int(self.rng.integers(len(self.cloths)))])

    def floor(self) -> dict[str, Any]:
        """Drawn."""
        kinds = HARD_FLOORS if self.hard else FLOORS
        texture, colour, tile_m = kinds[int(self.rng.integers(len(kinds)))]
        return {
            "texture": texture,
            "colour": list(colour),
            "seed": int(self.rng.integers(1, 40)),
            "tile_m": tile_m,
        }

    def ground(self, use: str) -> dict[str, Any]:
        """Under the open sky; no two repeats alike, as ground is."""
        return {**GROUNDS[use.split("_")[0]], "seed": int(self.rng.integers(1, 40)), "variants": 5}

    def walls(self) -> dict[str, Any]:
        """Drawn."""
        colour = WALLS[int(self.rng.integers(len(WALLS)))]
        texture = "bricks" if self.hard and self.rng.random() < 0.4 else "plaster"
        return {"texture": texture, "colour": list(colour), "seed": int(self.rng.integers(1, 40))}

    def ceiling(self) -> dict[str, Any]:
        """Light and even, as ceilings are."""
        return {"texture": "ceiling", "colour": [242, 240, 234], "seed": 1, "tile_m": 2.5}


def palette(rng: np.random.Generator, *, hard: bool) -> Palette:
    """Draw one.

    Args:
        rng: draws it, and later what is taken from it.
        hard: floors and walls of halls.
    """
    some = rng.permutation(len(CLOTHS))[:3]
    return Palette(list(WOODS[int(rng.integers(len(WOODS)))]), tuple(CLOTHS[int(k)] for k in some), rng, hard)
