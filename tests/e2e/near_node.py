"""A hiding place near a node of a small map, for tests that need a goal they can reach."""

import math

from services.launcher.evaluation.exploration import Exploration
from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace

OFFSETS_M = ((0.3, 0.0), (-0.3, 0.0), (0.0, 0.3), (0.0, -0.3), (0.0, 0.0))


def hiding_place_near_a_node(result: Exploration, space: FreeSpace, seeker: Pose) -> Pose:
    """A free pose beside the node that is farthest from the seeker, turned by one radian."""

    def away_m(pose: Pose) -> float:
        return math.hypot(pose.x_m - seeker.x_m, pose.y_m - seeker.y_m)

    node = max(result.truth.poses.values(), key=away_m)
    for dx_m, dy_m in OFFSETS_M:
        place = (node.x_m + dx_m, node.y_m + dy_m)
        if space.is_free(place):
            yaw_rad = math.remainder(node.yaw_rad + 1.0, math.tau)
            return Pose(x_m=place[0], y_m=place[1], yaw_rad=yaw_rad)
    raise AssertionError("no free place beside the node")
