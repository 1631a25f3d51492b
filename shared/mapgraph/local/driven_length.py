"""How far a new node is from one of its neighbours, by what the robot did. Pure."""

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.relative_poses import relative_poses


@dataclass(frozen=True)
class DrivenLength:
    """The distance to a node, and its standard deviation."""

    node_id: int
    length_m: float
    std_m: float


def driven_length(
    graph: MapGraph, here: Displacement, neighbours: Collection[int], most: int
) -> DrivenLength | None:
    """To the node that the robot came from, or to the neighbour whose place relative to it is known best.

    Args:
        graph: the map without the new node.
        here: where the new node is.
        neighbours: the nodes that it shares an edge with: not always the one that the robot came from, of
            which a corner may hide all but a few keypoints.
        most: nodes of the map reckoned with.
    """
    if here.node_id in neighbours:
        return DrivenLength(here.node_id, here.length_m, here.spread_m)
    if here.node_id not in graph.nodes:
        return None
    poses = relative_poses(graph, here.node_id, neighbours, most)
    if not poses:
        return None
    std_m = {node: math.sqrt(float(np.trace(pose.covariance_m2))) for node, pose in poses.items()}
    best = min(poses, key=lambda node: (std_m[node], node))
    length_m = math.dist(poses[best].position_m, (here.x_m, here.y_m))
    return DrivenLength(best, length_m, math.hypot(std_m[best], here.spread_m))
