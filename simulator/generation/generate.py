"""A world of a kind, a seed and a size: drawn, examined, and mended until the robot gets everywhere. Pure."""

from typing import Any

import numpy as np

from simulator.generation.door_signs import door_signs
from simulator.generation.furnishing import furnish
from simulator.generation.kinds import KINDS, SIZES
from simulator.generation.mending import GenerationError, mended
from simulator.generation.palettes import palette
from simulator.generation.pieces import Placed
from simulator.generation.splits import split_of
from simulator.generation.world_text import furnished, shell
from simulator.world.world_file import WorldFile


def generate(kind: str, seed: int, size: str = "medium") -> dict[str, Any]:
    """A world file's contents; the same for the same arguments.

    Args:
        kind: of `KINDS`.
        seed: draws everything.
        size: of `SIZES`.

    Raises:
        GenerationError: no such kind or size, or a world that cannot be mended.
    """
    if kind not in KINDS:
        raise GenerationError(f"kind must be one of {', '.join(KINDS)}; got {kind!r}")
    if size not in SIZES:
        raise GenerationError(f"size must be one of {', '.join(SIZES)}; got {size!r}")
    rng = np.random.default_rng([seed, SIZES.index(size), *kind.encode()])
    style = KINDS[kind]
    plan = style.plan(SIZES.index(size), rng)
    look = palette(rng, hard=style.hard)
    world = shell(f"{kind}-{seed}-{size}", style.wall_height_m, plan, look)
    world["generated"] = {"kind": kind, "seed": seed, "size": size, "split": split_of(kind, seed)}
    pieces = furnish(plan, look, style.wall_height_m, rng)

    def whole(some: list[Placed]) -> WorldFile:
        return WorldFile.model_validate(furnished(world, some))

    pieces = mended(pieces, whole)
    if style.signs:  # drawn apart: rooms and furniture stay those that the seed gave before there were signs
        pieces += door_signs(
            plan, pieces, np.random.default_rng([seed, SIZES.index(size), *b"signs", *kind.encode()])
        )
    return furnished(world, pieces)
