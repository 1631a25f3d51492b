"""Whether altered furniture leaves the robot its ways. Pure."""

import math
from collections.abc import Sequence

from experiments.changes.alterations import Alteration, Point
from simulator.world.changes import Changes, changed_world, with_item
from simulator.world.freespace import ground_clearance
from simulator.world.world_file import WorldFile

GAP_M = 0.82
"""The narrowest gap that the robot takes: a door in whose frame a leaf stands open."""


def shuts_off(world: WorldFile, altered: Sequence[Alteration], places: Sequence[Point]) -> bool:
    """Whether one of the places cannot be reached from the first one past the altered pieces.

    Args:
        world: as it is first.
        altered: pieces that are elsewhere, or gone.
        places: metres, all reached as the world is first.
    """
    changes: Changes = {}
    for each in altered:
        pose = None if each.pose is None else (each.pose.x_m, each.pose.y_m, each.pose.yaw_rad)
        changes = with_item(world, changes, each.name, None if pose else False, pose)
    return len(reached(changed_world(world, changes), places)) < len(places)


def reached(world: WorldFile, places: Sequence[Point]) -> list[Point]:
    """Those of the places that can be reached from the first one through gaps of GAP_M."""
    wide = ground_clearance(world, GAP_M / 2)
    return [place for place in places if math.isfinite(wide.shortest_path_m(places[0], place))]
