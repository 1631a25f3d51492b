"""A hiding place near a node of a small map, for tests that need a goal they can reach."""

import math

from services.launcher.evaluation.exploration import Exploration
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace

OFFSETS_M = ((0.3, 0.0), (-0.3, 0.0), (0.0, 0.3), (0.0, -0.3))
MARGIN_M = 0.1
"""Further from obstacles than a body needs, as goals of hide-and-seek are: a base keeps away from walls."""


def hiding_place_near_a_node(result: Exploration, space: FreeSpace, seeker: Pose) -> Pose:
    """A pose with room beside the node that is farthest from the seeker, or at it, turned by one radian."""

    def away_m(pose: Pose) -> float:
        return math.hypot(pose.x_m - seeker.x_m, pose.y_m - seeker.y_m)

    node = max(result.truth.poses.values(), key=away_m)

    def has_room(x_m: float, y_m: float) -> bool:
        around = [(MARGIN_M * dx, MARGIN_M * dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        return all(space.is_free((x_m + dx_m, y_m + dy_m)) for dx_m, dy_m in around)

    beside = ((node.x_m + dx_m, node.y_m + dy_m) for dx_m, dy_m in OFFSETS_M)
    place = next((spot for spot in beside if has_room(*spot)), (node.x_m, node.y_m))
    return Pose(x_m=place[0], y_m=place[1], yaw_rad=math.remainder(node.yaw_rad + 1.0, math.tau))
