"""Furniture that stands in the way, and is taken away: until the robot gets everywhere with ease. Pure."""

from collections.abc import Callable

import cv2
import numpy as np
import numpy.typing as npt

from simulator.generation.pieces import Placed
from simulator.generation.plans.rectangles import Point, Rect
from simulator.world.freespace import FreeSpace, free_space
from simulator.world.world_check import TIGHT_M, cut_off, examine
from simulator.world.world_file import WorldFile

MENDINGS = 25
"""Pieces taken away at most; chosen: with more the drawing is at fault."""
CUT_OFF_M2 = 0.3
"""Floor that may be out of reach: a corner behind a chair."""

Grid = npt.NDArray[np.bool_]


class GenerationError(ValueError):
    """A world cannot be generated; the message says what was asked for and what there is."""


def mended(pieces: list[Placed], world_of: Callable[[list[Placed]], WorldFile]) -> list[Placed]:
    """Without the pieces that keep the robot from getting everywhere.

    Args:
        pieces: all of them.
        world_of: the world with some of them.

    Raises:
        GenerationError: it is not furniture that stands in the way.
    """
    left = list(pieces)
    for _ in range(MENDINGS):
        wrong = wrong_at(world := world_of(left))
        if wrong is None:
            return left
        solid = [k for k, piece in enumerate(left) if piece.solid]
        if not solid:
            break
        del left[min(solid, key=lambda k: (max(left[k].box.gap_m(Rect(*wrong, *wrong)), 0.0), k))]
    raise GenerationError(f"{world.name}: floor near {wrong} cannot be reached whatever is taken away")


def wrong_at(world: WorldFile) -> Point | None:
    """A point near which something stands in the way; None where the robot gets everywhere with ease."""
    report = examine(world)
    if report.faults:
        return world.start.x_m, world.start.y_m
    for passage in report.passages:
        if passage.width_m < TIGHT_M:
            return passage.x_m, passage.y_m
    if report.cut_off_m2 <= CUT_OFF_M2 and not report.unreachable:
        return None
    space = free_space(world)
    lost = cut_off(space)
    if lost.any():
        return _gap_to(space, _largest(lost))
    room = next(room for room in world.rooms if room.name in report.unreachable)
    return sum(room.x_m) / 2, sum(room.y_m) / 2


def _largest(lost: Grid) -> Grid:
    _, pieces, stats, _ = cv2.connectedComponentsWithStats(lost.astype(np.uint8), connectivity=4)
    return np.asarray(pieces == 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA])))


def _gap_to(space: FreeSpace, lost: Grid) -> Point:
    """Where floor out of reach comes nearest to floor that is not."""
    far = [cv2.distanceTransform((~piece).astype(np.uint8), cv2.DIST_L2, 5) for piece in (space.free, lost)]
    between = far[0] + far[1] + np.abs(far[0] - far[1])
    row, column = np.unravel_index(int(np.argmin(between)), between.shape)
    return space.point((int(row), int(column)))
