"""The way to a goal picture that does not show from the last node: by where the map puts it. Pure.

Where nodes lie metres apart a picture between them resembles the nearest one enough to be located, but what
the robot sees there need not be enough to head for it.
"""

import math

import numpy as np

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.relative_poses import relative_poses

REACHED_M = 0.3
"""Who is nearer than this to where the map puts the picture sees it, or it is not there; chosen."""


def reckoned_rad(graph: MapGraph, here: Displacement | None, goal: Displacement | None) -> float | None:
    """Bearing of the spot where a picture was taken, robot frame; None where nobody knows or it is reached.

    Args:
        graph: the map.
        here: where the robot is.
        goal: where the picture was taken, relative to a node.
    """
    if here is None or goal is None or here.node_id not in graph.nodes:
        return None
    pose = relative_poses(graph, here.node_id, [goal.node_id], NEAR_NODES).get(goal.node_id)
    if pose is None:
        return None
    cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    spot = pose.position_m + np.array([[cos, -sin], [sin, cos]]) @ np.array([goal.x_m, goal.y_m])
    x_m, y_m = float(spot[0]) - here.x_m, float(spot[1]) - here.y_m
    if math.hypot(x_m, y_m) < REACHED_M:
        return None
    return math.remainder(math.atan2(y_m, x_m) - here.yaw_rad, math.tau)
