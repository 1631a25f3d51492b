"""World file -> every part and light of the world, in world coordinates. Pure."""

import math

from simulator.furniture.catalogue import FURNITURE
from simulator.scene.parts import Contents, Light, Part, Piece, moved
from simulator.world.grounds import ground_parts
from simulator.world.rooms import room_parts
from simulator.world.world_file import Item, WorldFile


def placed(item: Item) -> Piece:
    """A piece of furniture where the world has it."""
    piece = FURNITURE[item.kind].build(item.options, item.seed)
    return moved(piece, *item.at_m, math.radians(item.yaw_deg), item.z_m)


def expand(world: WorldFile) -> Contents:
    """All parts (building and grounds first, then furniture in file order) and all lights."""
    parts: list[Part] = [*room_parts(world), *ground_parts(world)]
    lights: list[Light] = []
    for item in world.furniture:
        piece = placed(item)
        parts.extend(piece.parts)
        lights.extend(piece.lights)
    return tuple(parts), tuple(lights)
