"""Long surfaces in panels of different texture, so that a wall does not look the same every few metres. Pure.

A texture that repeats along a wall makes places look alike at multiples of its period; real walls do not.
"""

import math
from itertools import pairwise

import numpy as np

Span = tuple[float, float]


def cut(span: Span, tile_m: float) -> list[Span]:
    """Cut at multiples of the tile, where textures meet; less than half a tile stays with its neighbour."""
    low, high = span
    first, last = math.ceil(low / tile_m), math.floor(high / tile_m)
    inner = [k * tile_m for k in range(first, last + 1)]
    inner = [at for at in inner if at - low > tile_m / 2 and high - at > tile_m / 2]
    ends = [low, *inner, high]
    return list(pairwise(ends))


def variant(count: int, *where: float) -> int:
    """Which of `count` textures a panel shows: irregular, but always the same at the same place."""
    if count <= 1:
        return 0
    cells = [round(10 * at) & 0xFFFF_FFFF for at in where]
    return int(np.random.default_rng([count, *cells]).integers(count))
