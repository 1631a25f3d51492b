"""Texture kinds by name, and `draw`, the one way to get a picture of a material."""

import inspect
from collections.abc import Callable

import numpy as np

from simulator.textures import materials, objects, outdoors, pictures, rugs, screens, surfaces
from simulator.textures.noise import Image, Rgb

KINDS: dict[str, Callable[[np.random.Generator, Rgb], Image]] = {
    name: function
    for module in (materials, objects, outdoors, pictures, rugs, screens, surfaces)
    for name, function in inspect.getmembers(module, inspect.isfunction)
    if function.__module__ == module.__name__ and not name.startswith("_")
}
"""Every public function of these modules draws the kind of its name."""


def draw(kind: str, colour: Rgb, seed: int) -> Image:
    """Draw a texture.

    Args:
        kind: a key of KINDS.
        colour: main colour, RGB 0..255; kinds that have their own palette ignore it.
        seed: same kind, colour and seed give the same bytes.

    Returns:
        (height, width, 3) RGB bytes, row 0 at the top.

    Raises:
        ValueError: the kind is unknown.
    """
    if kind not in KINDS:
        raise ValueError(f"texture kind must be one of {', '.join(sorted(KINDS))}; got {kind!r}")
    return KINDS[kind](np.random.default_rng([seed, *kind.encode()]), colour)
