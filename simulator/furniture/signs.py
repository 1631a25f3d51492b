"""What is put up to be read: plates beside doors."""

from functools import partial
from hashlib import sha256
from typing import Literal

import numpy as np

from simulator.scene.parts import Material, Picture, Piece, Rgb
from simulator.scene.shapes import detail, label
from simulator.textures.lettering import plate

LOOKS: dict[str, tuple[Rgb, Rgb]] = {
    "white": ((24, 26, 30), (242, 242, 238)),
    "blue": ((244, 246, 250), (22, 62, 122)),
    "steel": ((30, 32, 36), (196, 200, 204)),
}
"""Ink and ground."""


def door_sign(
    rng: np.random.Generator,
    text: str = "101",
    width_m: float = 0.3,
    height_m: float = 0.2,
    look: Literal["white", "blue", "steel"] = "white",
) -> Piece:
    """Plate with a line of text facing +x, its centre at the item's height."""
    del rng
    ink, ground = LOOKS[look]
    drawn = partial(plate, text, round(width_m / height_m, 3), ink, ground)
    digest = sha256(repr(("door_sign", *drawn.args)).encode()).hexdigest()
    half, tall = width_m / 2, height_m / 2
    face = Material("sign", ground, picture=Picture(digest, drawn))
    return Piece.of(
        detail((0.0, 0.01), (-half, half), (-tall, tall), Material("lacquer", ground, 6)),
        label((0.01, 0.012), (-half, half), (-tall, tall), face),
    )
