"""Where the robot starts in a world that does not say, and what floor it reaches from there. Pure."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from simulator.importing.entities import Vec3
from simulator.world.freespace import FreeSpace, ground_clearance
from simulator.world.world_check import ROBOT_RADIUS_M
from simulator.world.world_file import WorldFile

ROOM_M = 0.6  # more room than this round the start is of no use; chosen: it can leave in any direction
WIDE_M = 2.0  # half the floor so far from everything is no indoor place; chosen: rooms have less
EDGE_M = 0.3  # this near the end of the ground the robot reaches it; chosen: more than its radius
LEAST_M2 = 1.0  # less free floor is no place to drive in; chosen
CLOSED_SHARE = 0.25  # rooms are meant, not the land round them, if they have this share of it; chosen
Grid = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.integer]


@dataclass(frozen=True)
class StartPlace:
    """A start and the floor round it.

    Attributes:
        pose: x, y (metres) and heading (degrees).
        x_m, y_m: a rectangle round the floor that is reached from there.
        to_the_edge: whether that goes as far as the world's ground.
        wide: whether most of it is far from everything, as outdoors.
    """

    pose: Vec3
    x_m: tuple[float, float]
    y_m: tuple[float, float]
    to_the_edge: bool
    wide: bool


def find_start(world: WorldFile, given: Vec3 | None) -> StartPlace | None:
    """The start that is given, else the widest place of the largest free floor; None without free floor."""
    space = ground_clearance(world)
    free = space.clearance_m >= ROBOT_RADIUS_M
    count, labels, stats, centres = cv2.connectedComponentsWithStats(free.astype(np.uint8), connectivity=4)
    reach = round((EDGE_M + ROBOT_RADIUS_M) / space.resolution_m)
    if given is not None:
        row, column = space.cell(given[:2])
        inside = 0 <= row < free.shape[0] and 0 <= column < free.shape[1]
        chosen = int(labels[row, column]) if inside else 0
    else:
        chosen = _largest(stats[:count], free.shape, reach)
    if not chosen or stats[chosen, cv2.CC_STAT_AREA] * space.resolution_m**2 < LEAST_M2:
        return None
    reached = np.asarray(labels == chosen)
    pose = given or _widest(space, reached, (float(centres[chosen][0]), float(centres[chosen][1])))
    rows, columns = np.nonzero(reached)
    (x0, y0), (x1, y1) = (
        space.point((int(rows.min()), int(columns.min()))),
        space.point((int(rows.max()), int(columns.max()))),
    )
    to_the_edge = _at_the_edge(stats[chosen], free.shape, reach)
    wide = float(np.median(space.clearance_m[reached])) >= WIDE_M
    return StartPlace(pose, (x0, x1), (y0, y1), to_the_edge, wide)


def _largest(stats: IntArray, shape: tuple[int, ...], reach: int) -> int:
    """Label of the largest piece of floor; of the largest that is closed in where that is large as well."""
    areas = stats[:, cv2.CC_STAT_AREA].copy()
    areas[0] = 0
    closed = np.array([0 if _at_the_edge(one, shape, reach) else 1 for one in stats]) * areas
    best = closed if closed.max(initial=0) >= CLOSED_SHARE * areas.max(initial=0) else areas
    return int(np.argmax(best))


def _at_the_edge(stats: IntArray, shape: tuple[int, ...], reach: int) -> bool:
    """Whether a piece of floor comes so many cells near the end of the grid."""
    left, top, width, height = (int(stats[k]) for k in range(4))  # as OpenCV orders them
    return min(left, top, shape[1] - left - width, shape[0] - top - height) <= reach


def _widest(space: FreeSpace, reached: Grid, middle: tuple[float, float]) -> Vec3:
    """The place with most room, of equals that nearest to the middle, a (column, row)."""
    room = np.where(reached, np.minimum(space.clearance_m, ROOM_M), -1.0)
    rows, columns = np.nonzero(room >= room.max())
    k = int(np.argmin((columns - middle[0]) ** 2 + (rows - middle[1]) ** 2))
    x, y = space.point((int(rows[k]), int(columns[k])))
    return round(x, 3), round(y, 3), 0.0
