"""The way to a goal picture or a node that does not show: by where the map puts it. Pure.

Where nodes lie metres apart a picture between them resembles the nearest one enough to be located, but what
the robot sees there need not be enough to head for it. Behind a door furniture may have moved.
"""

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.relative_poses import relative_poses
from shared.mapgraph.local.view_range import edge_length_m
from shared.mapgraph.routing import GOAL
from shared.motion.motion import Motion

REACHED_M = 0.3
"""Who is nearer than this to where the map puts the picture sees it, or it is not there; chosen."""


def reckoned(
    graph: MapGraph, here: Displacement | None, goal: Displacement | None
) -> tuple[float, float] | None:
    """Bearing of a spot in the robot frame, radians, and its distance in metres; None where nobody knows.

    Args:
        graph: the map.
        here: where the robot is.
        goal: the spot, relative to a node.
    """
    if here is None or goal is None or here.node_id not in graph.nodes:
        return None
    pose = relative_poses(graph, here.node_id, [goal.node_id], NEAR_NODES).get(goal.node_id)
    if pose is None:
        return None
    node_x_m, node_y_m = (float(metres) for metres in pose.position_m)
    spot = Displacement(here.node_id, node_x_m, node_y_m, pose.yaw_rad).moved(Motion(goal.x_m, goal.y_m))
    x_m, y_m = spot.x_m - here.x_m, spot.y_m - here.y_m
    return math.remainder(math.atan2(y_m, x_m) - here.yaw_rad, math.tau), math.hypot(x_m, y_m)


def along_edges(graph: MapGraph, path: Sequence[int]) -> Displacement | None:
    """Where the last of some nodes lies relative to the first, edge by edge; None where an edge does not say.

    For suspended edges, which do not count where nodes lie by all that is known of them.
    """
    spot = Displacement(path[0])
    for a, b in pairwise(path):
        edge = graph.edge(a, b)
        if edge is None or edge.yaw_ab_rad is None:
            return None
        forward, length_m = edge.a == a, edge_length_m(graph, edge)
        heading_rad = edge.heading_ab_rad if forward else edge.heading_ba_rad
        yaw_rad = edge.yaw_ab_rad if forward else -edge.yaw_ab_rad
        if heading_rad is None:
            return None
        way = Motion(length_m * math.cos(heading_rad), length_m * math.sin(heading_rad), yaw_rad)
        spot = spot.moved(way)
    return spot


def reckoned_end(
    graph: MapGraph, here: Displacement | None, path: Sequence[int]
) -> tuple[float, float] | None:
    """Bearing and distance of the last node of a path, over edges that are suspended by these alone."""
    legs = (along_edges(graph, path[first:]) for first in range(len(path) - 1, -1, -1))
    return next((spot for leg in legs if (spot := reckoned(graph, here, leg)) is not None), None)


def next_reckoned(
    graph: MapGraph,
    here: Displacement | None,
    path: Sequence[int],
    ahead: Iterable[int],
    picture: Displacement | None,
) -> tuple[int, float, float] | None:
    """The first waypoint that the robot is not at by the map, as it lies from here.

    Args:
        graph: the map.
        here: where the robot is.
        path: nodes, and at its end maybe GOAL.
        ahead: indices of the waypoints to ask for, in order.
        picture: where the goal picture was taken, relative to a node.

    Returns:
        Its index, bearing in the robot frame (radians) and distance (metres); None where nobody knows.
    """
    for index in ahead:
        if path[index] == GOAL:
            spot = reckoned(graph, here, picture)
        else:
            spot = reckoned_end(graph, here, path[: index + 1])
        if spot is None or spot[1] >= REACHED_M:
            return None if spot is None else (index, *spot)
    return None


def reckoned_rad(graph: MapGraph, here: Displacement | None, goal: Displacement | None) -> float | None:
    """Bearing of the spot where a picture was taken, robot frame; None where nobody knows or it is reached.

    Args:
        graph: the map.
        here: where the robot is.
        goal: where the picture was taken, relative to a node.
    """
    spot = reckoned(graph, here, goal)
    return None if spot is None or spot[1] < REACHED_M else spot[0]
