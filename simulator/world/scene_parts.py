"""World file -> every part and light of the world, in world coordinates. Pure."""

import math

from simulator.furniture.catalogue import FURNITURE
from simulator.scene.parts import Light, Part, moved
from simulator.world.grounds import ground_parts
from simulator.world.rooms import room_parts
from simulator.world.world_file import WorldFile


def expand(world: WorldFile) -> tuple[tuple[Part, ...], tuple[Light, ...]]:
    """All parts (building and grounds first, then furniture in file order) and all lights."""
    parts: list[Part] = [*room_parts(world), *ground_parts(world)]
    lights: list[Light] = []
    for item in world.furniture:
        piece = FURNITURE[item.kind].build(item.options, item.seed)
        placed = moved(piece, *item.at_m, math.radians(item.yaw_deg), item.z_m)
        parts.extend(placed.parts)
        lights.extend(placed.lights)
    return tuple(parts), tuple(lights)
