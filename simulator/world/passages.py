"""Narrow passages of a world: where the free floor would fall apart for a wider robot. Pure."""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from simulator.world.freespace import FreeSpace

Grid = npt.NDArray[np.bool_]
STEP_M = 0.02  # widths are found to twice this; chosen: finer than the grid
WIDEST_M = 1.6  # what is wider is no passage; chosen: a double door
LEAST_AREA_M2 = 0.5  # less floor than this is a niche, not a room; chosen: where the robot could turn


@dataclass(frozen=True)
class Passage:
    """A gap on the way: its width between obstacles, its place, and how much floor lies behind it."""

    width_m: float
    x_m: float
    y_m: float
    behind_m2: float


def narrow_passages(space: FreeSpace) -> list[Passage]:
    """Passages up to WIDEST_M wide, narrowest first.

    The clearance needed grows step by step; where floor of at least LEAST_AREA_M2 comes apart, there was a
    passage, as wide as twice the clearance between this step and the last.
    """
    cell_m2 = space.resolution_m**2
    found: list[Passage] = []
    before = space.free
    for need in np.arange(space.robot_radius_m + STEP_M, WIDEST_M / 2, STEP_M):
        now = before & (space.clearance_m >= need)
        for floor, child, main in _come_apart(before, now, round(LEAST_AREA_M2 / cell_m2)):
            row, column = _between(floor, child, main, space.clearance_m)
            x, y = space.point((row, column))
            width, area = 2 * float(need) - STEP_M, float(child.sum()) * cell_m2
            found.append(Passage(round(width, 2), round(x, 2), round(y, 2), round(area, 2)))
        before = now
    return sorted(found, key=lambda passage: passage.width_m)


def _come_apart(before: Grid, now: Grid, least: int) -> Iterator[tuple[Grid, Grid, Grid]]:
    """Pieces of `now` that were one piece before: that piece, the smaller, and the largest of them."""
    _, pieces, stats, _ = cv2.connectedComponentsWithStats(now.astype(np.uint8), connectivity=4)
    areas = stats[1:, cv2.CC_STAT_AREA]
    large = [int(k) + 1 for k in np.argsort(-areas, kind="stable") if areas[k] >= least]
    if len(large) < 2:
        return
    _, whole = cv2.connectedComponents(before.astype(np.uint8), connectivity=4)
    largest: dict[int, Grid] = {}
    for k in large:
        piece = pieces == k
        parent = int(whole[np.unravel_index(int(np.argmax(piece)), piece.shape)])
        if parent in largest:
            yield whole == parent, piece, largest[parent]
        else:
            largest[parent] = piece


def _between(floor: Grid, one: Grid, other: Grid, clearance_m: npt.NDArray[np.float64]) -> tuple[int, int]:
    """The lost cell nearest to both pieces, the widest of equals."""
    far = [cv2.distanceTransform((~piece).astype(np.uint8), cv2.DIST_L2, 5) for piece in (one, other)]
    score = np.where(floor & ~one & ~other, far[0] + far[1] + np.abs(far[0] - far[1]) - clearance_m, np.inf)
    row, column = np.unravel_index(int(np.argmin(score)), score.shape)
    return int(row), int(column)
