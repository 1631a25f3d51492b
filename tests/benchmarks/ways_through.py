"""Ways through a world that was played in, and where a robot on them is relative to its map."""

import itertools
import math

import networkx as nx

from shared.mapgraph.local.displacement import Displacement
from shared.messages.simulation import Pose
from shared.motion.motion import Motion, rotated


def poses_along(played, free, rng, every_m, begin=0.0):
    """Poses along a way that is the shortest between two nodes drawn by chance, so far apart.

    Args:
        played: the world.
        free: where a robot may stand.
        rng: draws the nodes.
        every_m: way between two poses.
        begin: where the first one is, as a share of the first leg.
    """
    at = {node: (pose.x_m, pose.y_m) for node, pose in played.poses.items()}
    ways = nx.Graph()
    ways.add_weighted_edges_from((a, b, math.dist(at[a], at[b])) for a, b in played.graph.edges)
    first, last = rng.choice(sorted(nx.node_connected_component(ways, min(ways))), 2, replace=False)
    left_m = None
    for here, there in itertools.pairwise(nx.shortest_path(ways, first, last, "weight")):
        (x, y), (u, v) = at[here], at[there]
        length_m = math.dist(at[here], at[there])
        way_m = begin * length_m if left_m is None else left_m
        while way_m < length_m:
            share = way_m / length_m
            pose = Pose(x_m=x + share * (u - x), y_m=y + share * (v - y), yaw_rad=math.atan2(v - y, u - x))
            if free.is_free((pose.x_m, pose.y_m)):
                yield pose
            way_m += every_m
        left_m = way_m - length_m


def moved(before, after):
    """The motion from one pose to another, in the robot's frame at the first."""
    x_m, y_m = rotated(after.x_m - before.x_m, after.y_m - before.y_m, -before.yaw_rad)
    return Motion(x_m, y_m, math.remainder(after.yaw_rad - before.yaw_rad, math.tau))


def about(played, pose, spread_m):
    """Where that is, relative to the node nearest to it."""
    node, near = min(
        played.poses.items(), key=lambda item: math.dist((item[1].x_m, item[1].y_m), (pose.x_m, pose.y_m))
    )
    there = moved(near, pose)
    return Displacement(node, there.x_m, there.y_m, there.turn_rad, spread_m)
