"""Furniture that was moved or taken away since the map was made. Pure.

Movable is what stands on the floor by itself and is no larger than a person would push. Some of it is gone,
the rest was shifted and turned; nothing overlaps, the start stays free and the free floor stays in one piece.
"""

import math

import numpy as np

from simulator.disturbances.levels import generator
from simulator.furniture.catalogue import FURNITURE
from simulator.scene.mesh_shapes import mesh_of
from simulator.scene.meshes import surface_points
from simulator.world.changes import Changes, at_pose, changed_world, item_names
from simulator.world.contents import expand, placed
from simulator.world.footprints import Footprints, clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M, FreeSpace, free_space
from simulator.world.items import Item
from simulator.world.world_file import WorldFile

# All chosen: what a household changes within a week.
LARGEST_M = 1.3  # of what one person pushes
MOST_SHARE = 0.7  # of the movable items, at level 1
GONE_SHARE = 0.25  # of those
SHIFT_M, TURN_RAD = 0.7, 0.8  # at level 1, to either side
TRIES = 25  # places tried before it is taken away
GRID_M = 0.1  # twice that in worlds larger than LARGE_M
LARGE_M = 40.0
KEPT_FLOOR = 0.93  # free floor that must stay reachable
START_M = 0.6  # from the robot's start
SPACING_M = 0.08  # of the points of an item that are looked at


def rearranged(world: WorldFile, level: float, seed: int) -> dict[str, Item | None]:
    """Changes for a level; empty at level 0."""
    if level == 0.0:
        return {}
    rng = generator(seed, "furniture")
    items = dict(zip(item_names(world), world.furniture, strict=True))
    movable = [name for name, item in items.items() if is_movable(item) and not _carries(item, world)]
    count = math.ceil(MOST_SHARE * level * len(movable))
    before = _reachable(world)
    changes: dict[str, Item | None] = {}
    for name in rng.permutation(movable)[:count]:
        changes[str(name)] = _moved(world, changes, str(name), items[str(name)], level, rng)
    if _reachable(changed_world(world, changes)) >= KEPT_FLOOR * before:
        return changes
    return _harmless(world, changes, before)


def _harmless(world: WorldFile, changes: Changes, before: float) -> dict[str, Item | None]:
    """The changes without those that cut off a part of the floor."""
    kept: dict[str, Item | None] = {}
    for name, item in changes.items():
        tried = {**kept, name: item}
        if _reachable(changed_world(world, tried)) >= KEPT_FLOOR * before:
            kept = tried
    return kept


def is_movable(item: Item) -> bool:
    """Whether a person could push it: it stands on the floor and is small."""
    if item.z_m > 0.0:
        return False
    solids = [part for part in FURNITURE[item.kind].build(item.options, item.seed).parts if part.solid]
    if not solids:
        return False
    low = min(part.centre_m[2] - part.size_m[2] / 2 for part in solids)
    reach = max(max(abs(part.centre_m[k]) + part.size_m[k] / 2 for k in (0, 1)) for part in solids)
    high = max(part.centre_m[2] + part.size_m[2] / 2 for part in solids)
    return low < 0.05 and reach <= LARGEST_M / 2 and 0.1 < high < 2.0


def _carries(item: Item, world: WorldFile) -> bool:
    """Whether something stands or hangs above an item's origin, as a lamp on a table does."""
    return any(
        other.z_m > 0.0 and math.dist(other.at_m, item.at_m) < LARGEST_M / 2 for other in world.furniture
    )


def _moved(
    world: WorldFile, changes: Changes, name: str, item: Item, level: float, rng: np.random.Generator
) -> Item | None:
    """A new place for an item where it touches nothing; None if it is taken away or finds none."""
    if rng.random() < GONE_SHARE:
        return None
    others, _ = expand(changed_world(world, {**changes, name: None}))
    standing = footprints(others, *BODY_BAND_M)
    for _ in range(TRIES):
        reach_m, turn = SHIFT_M * (0.4 + 0.6 * level), TURN_RAD * (0.4 + 0.6 * level)
        dx_m, dy_m = rng.uniform(-reach_m, reach_m, 2).tolist()
        yaw_rad = math.radians(item.yaw_deg) + float(rng.uniform(-turn, turn))
        tried = at_pose(item, (item.at_m[0] + dx_m, item.at_m[1] + dy_m, yaw_rad))
        if _fits(world, tried, standing):
            return tried
    return None


def _fits(world: WorldFile, item: Item, standing: Footprints) -> bool:
    """Whether an item touches no outline, stands on floor and leaves the start free."""
    solids = [part for part in placed(item).parts if part.solid]
    points = np.concatenate([surface_points(mesh_of(part), SPACING_M) for part in solids])[:, :2]
    if not all(world.holds(x_m, y_m) for x_m, y_m in points.tolist()):
        return False
    if np.hypot(*(points - [world.start.x_m, world.start.y_m]).T).min() < START_M:
        return False
    return bool(clearance_m(points, standing).min() > 0.0)


def _reachable(world: WorldFile) -> float:
    """Cells of free floor connected to the start."""
    span_m = max(high for rect in world.rectangles() for _, high in rect)
    try:
        space: FreeSpace = free_space(world, resolution_m=GRID_M if span_m < LARGE_M else 2 * GRID_M)
    except ValueError:
        return 0.0
    return float(space.free.sum())
