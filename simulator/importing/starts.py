"""Where the robot starts in a world that does not say: in the widest part of the largest free floor. Pure."""

import cv2
import numpy as np

from simulator.importing.entities import Vec3
from simulator.world.freespace import ground_clearance
from simulator.world.world_check import ROBOT_RADIUS_M
from simulator.world.world_file import WorldFile

ROOM_M = 0.6  # more room than this round the start is of no use; chosen: it can leave in any direction


def find_start(world: WorldFile) -> Vec3 | None:
    """x, y (metres) and heading (degrees); None if the robot fits nowhere."""
    grid = ground_clearance(world)
    free = grid.clearance_m >= ROBOT_RADIUS_M
    count, labels, stats, centres = cv2.connectedComponentsWithStats(free.astype(np.uint8), connectivity=4)
    if count < 2:
        return None
    largest = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    wide = np.where(labels == largest, np.minimum(grid.clearance_m, ROOM_M), -1.0)
    rows, columns = np.nonzero(wide >= wide.max())
    middle = centres[largest]  # column, row
    k = int(np.argmin((columns - middle[0]) ** 2 + (rows - middle[1]) ** 2))
    x, y = grid.point((int(rows[k]), int(columns[k])))
    return round(x, 3), round(y, 3), 0.0
