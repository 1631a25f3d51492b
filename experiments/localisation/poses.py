"""Poses to take pictures at: in parts of the world that a map shows, or in others. Pure."""

import math
from collections.abc import Callable, Collection

import numpy as np

from shared.messages.simulation import Pose

MAPPED_M = 1.0
"""As near to a node as the floor that counts as covered."""
UNMAPPED_M = 2.5
"""Further from any node than two of them recognise each other."""
MAX_DRAWS = 20_000
"""Finds one part in a thousand of the floor but for 2 times in a billion."""

Draw = Callable[[np.random.Generator], tuple[float, float, float]]


def poses_of(
    draw: Draw, nodes: Collection[Pose], count: int, rng: np.random.Generator, *, mapped: bool
) -> list[Pose]:
    """Random poses near a node, or far from all of them.

    Raises:
        ValueError: the map leaves no such floor.
    """
    found: list[Pose] = []
    for _ in range(MAX_DRAWS):
        x_m, y_m, yaw_rad = draw(rng)
        away_m = min((math.hypot(n.x_m - x_m, n.y_m - y_m) for n in nodes), default=math.inf)
        if away_m < MAPPED_M if mapped else away_m > UNMAPPED_M:
            found.append(Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad))
        if len(found) == count:
            return found
    which = f"within {MAPPED_M} m of a node" if mapped else f"more than {UNMAPPED_M} m from all nodes"
    raise ValueError(f"{len(found)} of {count} free spots {which} in {MAX_DRAWS} draws")
