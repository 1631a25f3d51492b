"""Places that look alike and are not the same: the same spot of two rooms of equal size. Pure."""

import math
from itertools import combinations

import numpy as np

from experiments.rendered.pairs import MAX_DRAWS, PosePair
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace
from simulator.world.world_file import Room, WorldFile

SAME_M = 0.01
"""Rooms whose sides differ by less are furnished alike where the kind of world does that."""
APART_M = 4.0
"""Places at least so far apart that do not see each other show different things; chosen."""


def draw_strangers(world: WorldFile, space: FreeSpace, rng: np.random.Generator) -> PosePair | None:
    """Two poses that do not see each other, in equal rooms where there are any; None if none are found."""
    twins = [both for both in combinations(world.rooms, 2) if _equal(*both)]
    for draw in range(MAX_DRAWS // 10):
        x_m, y_m, yaw_rad = space.random_pose(rng)
        if twins and draw % 2 == 0:
            first, second = twins[int(rng.integers(len(twins)))]
            start, end, turn_rad = _same_spot(first, second, rng)
            here, there = Pose(x_m=start[0], y_m=start[1], yaw_rad=yaw_rad), (*end, yaw_rad + turn_rad)
        else:
            here, there = Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad), space.random_pose(rng)
        ends = (here.x_m, here.y_m), (there[0], there[1])
        if math.dist(*ends) < APART_M or not all(map(space.is_free, ends)) or space.line_of_sight(*ends):
            continue
        return PosePair(here, Pose(x_m=there[0], y_m=there[1], yaw_rad=math.remainder(there[2], math.tau)))
    return None


def _same_spot(
    first: Room, second: Room, rng: np.random.Generator
) -> tuple[tuple[float, float], tuple[float, float], float]:
    """A place in the first room, its twin in the second, and the turn of the second: half or none."""
    share = rng.random(2)
    half = bool(rng.random() < 0.5)
    other = 1.0 - share if half else share
    return _at(first, share), _at(second, other), math.pi if half else 0.0


def _at(room: Room, share: np.ndarray) -> tuple[float, float]:
    (x0, x1), (y0, y1) = room.x_m, room.y_m
    return float(x0 + share[0] * (x1 - x0)), float(y0 + share[1] * (y1 - y0))


def _equal(one: Room, other: Room) -> bool:
    sides = zip((one.x_m, one.y_m), (other.x_m, other.y_m), strict=True)
    return all(abs((a[1] - a[0]) - (b[1] - b[0])) < SAME_M for a, b in sides)
