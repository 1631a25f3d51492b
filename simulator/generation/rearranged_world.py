"""A world as it may be found later: furniture changed, other light, doors opened."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from simulator.assets.folder import AssetFolder
from simulator.cache_folder import user_cache
from simulator.generation.mending import mended, wrong_at
from simulator.generation.pieces import Placed, piece_at
from simulator.generation.rearranging import Rearranging
from simulator.generation.world_text import write_world
from simulator.world.world_file import WorldFile, read_contents, world_of, world_path

LEAVES = 1 / 3
"""Share of doorways where a leaf stands open that was not there; chosen."""
LIGHT = (0.7, 1.3)
"""How much darker or brighter lamps and even light get; chosen."""
SUN_DEG = (40.0, 120.0)
"""How far the sun moves on: three to eight hours."""

Contents = dict[str, Any]


def rearrange_file(world: str, into: Path, seed: int, share: float = 0.3) -> WorldFile:
    """Write a world file rearranged; see `rearranged`.

    Args:
        world: name or path.
        into: file to write; beside the old one if that names models or pictures.
        seed: draws everything.
        share: of the pieces that can be carried, 0 to 1.

    Raises:
        WorldFileError: the world, or what was made of it, cannot be used.
        GenerationError: the robot cannot get everywhere whatever is taken away.
    """
    path = world_path(world)
    assets = AssetFolder(path.parent, user_cache())
    contents = rearranged(
        read_contents(path), lambda some: world_of(path, some, assets), np.random.default_rng(seed), share
    )
    return write_world(into, {**contents, "name": f"{contents['name']}-rearranged"})


def rearranged(
    contents: Contents, load: Callable[[Contents], WorldFile], rng: np.random.Generator, share: float = 0.3
) -> Contents:
    """The contents of a world file after people lived there for a while.

    Of the furniture that people can carry, `share` is changed: a third of it taken away, a third moved and
    turned within its room, a third exchanged for something else of that world; what stands on a piece goes
    with it. Lamps, even light and sun are others, and some doorways have an open leaf.

    Args:
        contents: of a world file; copies of groups stay as they are.
        load: makes a world of contents.
        rng: draws everything.
        share: of the pieces that can be carried, 0 to 1.

    Raises:
        GenerationError: the robot got everywhere before and cannot now, whatever is taken away.
    """
    world, items = load(contents), contents.get("furniture", [])
    room = Rearranging(world, len(items), rng)
    for k in rng.permutation(room.movable)[: round(share * len(room.movable))].tolist():
        (room.remove, room.move, room.exchange)[int(rng.integers(3))](k)
    kept = [
        (_looks(item, items[source]), piece)
        for item, piece, source in zip(items, room.pieces, room.sources, strict=False)
        if piece is not None
    ]
    kept += [({}, leaf) for leaf in _leaves(world, rng)]
    strength = float(rng.uniform(*LIGHT))
    written = {id(piece): _written(item, piece, strength) for item, piece in kept}
    lit = _other_light(contents, world, rng)

    def whole(some: list[Placed]) -> Contents:
        return {**lit, "furniture": [written[id(piece)] for piece in some]}

    pieces = [piece for _, piece in kept]
    if wrong_at(world) is not None:  # it was not easy before: no use in taking more away
        return whole(pieces)
    return whole(mended(pieces, lambda some: load(whole(some))))


def _looks(item: Contents, other: Contents) -> Contents:
    """The item itself, or nothing but the kind and the options of another that takes its place."""
    return item if item is other else {key: other[key] for key in ("kind", "options") if key in other}


def _written(item: Contents, piece: Placed, strength: float) -> Contents:
    """An item where its piece stands; options keep the words they were written in, lamps shine otherwise."""
    if not item:
        item = {"kind": piece.kind, "options": piece.options}
    options = item.get("options", {})
    if "strength" in options:
        item = {**item, "options": {**options, "strength": round(options["strength"] * strength, 2)}}
    places = {
        "at_m": list(piece.at_m),
        "yaw_deg": round(piece.yaw_deg, 1),
        "z_m": piece.z_m,
        "seed": piece.seed,
    }
    return {**item, **{key: value for key, value in places.items() if value or key in item}}


def _leaves(world: WorldFile, rng: np.random.Generator) -> list[Placed]:
    """Open leaves in some doorways, hinged on one side and turned into the room."""
    found = []
    for opening in world.openings:
        if rng.random() >= LEAVES:
            continue
        (x0, x1), (y0, y1) = opening.x_m, opening.y_m
        along_y = x1 - x0 < y1 - y0
        wide_m, deep_m = (y1 - y0, x1 - x0) if along_y else (x1 - x0, y1 - y0)
        at_m = (x1, (y0 + y1) / 2) if along_y else ((x0 + x1) / 2, y1)
        options = {"width_m": round(wide_m, 3), "depth_m": round(deep_m, 3), "height_m": opening.height_m}
        found.append(piece_at("open_door", at_m, 0.0 if along_y else 90.0, 0, options))
    return found


def _other_light(contents: Contents, world: WorldFile, rng: np.random.Generator) -> Contents:
    """With other even light; under the open sky the sun has moved on."""
    even = np.array(world.lighting.ambient) * rng.uniform(*LIGHT)
    lit = {**contents, "lighting": {**contents.get("lighting", {}), "ambient": even.round(3).tolist()}}
    if world.sun is not None:
        azimuth_deg = math.remainder(world.sun.azimuth_deg + rng.uniform(*SUN_DEG), 360.0)
        lit["sun"] = {**contents["sun"], "azimuth_deg": round(azimuth_deg, 1)}
    return lit
