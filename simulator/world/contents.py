"""World file -> every part and light of the world, in world coordinates. Pure."""

import math
from dataclasses import replace

from simulator.furniture.catalogue import FURNITURE
from simulator.scene.parts import Contents, Light, Part, Piece, moved
from simulator.world.brought_floor import edges
from simulator.world.grounds import ground_parts
from simulator.world.items import Item
from simulator.world.rooms import room_parts
from simulator.world.world_file import WorldFile


def placed(item: Item, alike: bool = False) -> Piece:
    """A piece of furniture where the world has it; of the same grain as its equals elsewhere, or not."""
    piece = FURNITURE[item.kind].build(item.options, item.seed)
    if alike:
        piece = replace(piece, parts=tuple(replace(p, texture_at_m=p.centre_m) for p in piece.parts))
    return moved(piece, *item.at_m, math.radians(item.yaw_deg), item.z_m)


def expand(world: WorldFile) -> Contents:
    """All parts (building and grounds first, then furniture in file order, then edges) and all lights."""
    parts: list[Part] = [*room_parts(world), *ground_parts(world)]
    if world.alike:
        parts = [replace(part, texture_at_m=(0.0, 0.0, 0.0)) for part in parts]
    lights: list[Light] = []
    for item in world.furniture:
        piece = placed(item, world.alike)
        parts.extend(piece.parts)
        lights.extend(piece.lights)
    parts += edges(world, tuple(parts))
    return tuple(parts), tuple(lights)
