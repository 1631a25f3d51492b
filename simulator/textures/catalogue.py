"""Texture kinds by name, and `draw`, the one way to get a picture of a material."""

from collections.abc import Callable

import numpy as np

from simulator.textures import materials, objects, outdoors, pictures, rugs, surfaces
from simulator.textures.noise import Image, Rgb

KINDS: dict[str, Callable[[np.random.Generator, Rgb], Image]] = {
    function.__name__: function
    for function in (
        surfaces.plaster,
        surfaces.ceiling,
        surfaces.boards,
        surfaces.tiles,
        materials.wood,
        materials.fabric,
        materials.leather,
        materials.pattern_cloth,
        materials.metal,
        materials.lacquer,
        materials.ceramic,
        materials.leaf,
        materials.wicker,
        materials.glow,
        pictures.landscape,
        pictures.abstract,
        pictures.still_life,
        pictures.street,
        pictures.poster,
        outdoors.asphalt,
        outdoors.grass,
        outdoors.paving,
        outdoors.bricks,
        outdoors.roof_tiles,
        outdoors.concrete,
        outdoors.planks,
        outdoors.bark,
        outdoors.foliage,
        rugs.persian,
        rugs.kilim,
        rugs.modern,
        objects.books,
        objects.door,
        objects.radiator,
        objects.screen,
        objects.clock,
        objects.panel,
        objects.mirror,
        objects.view,
    )
}


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
