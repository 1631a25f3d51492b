"""A map of nodes on a square grid, a metre apart, whose cameras all look along x."""

import math

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import Claim
from shared.messages.maps import Edge, Node

GRID_HALF_M = 0.42
"""How far views carry: nodes a metre apart share 80 matches of 300."""


def at(node, columns):
    return node % columns, node // columns


def edge(a, b, columns, *, driven=True):
    (ax, ay), (bx, by) = at(a, columns), at(b, columns)
    heading_rad, length_m = math.atan2(by - ay, bx - ax), math.hypot(bx - ax, by - ay)
    return Edge(
        a=a, b=b, inliers=80, heading_ab_rad=heading_rad,
        heading_ba_rad=math.remainder(heading_rad + math.pi, math.tau), yaw_ab_rad=0.0,
        disparity_rad=0.15 * length_m, length_m=length_m if driven else None, traversals=int(driven),
    )  # fmt: skip


def grid(columns, rows):
    """Edges join the four neighbours of each node and those across."""
    nodes = [Node(node_id=n) for n in range(columns * rows)]
    pairs = [(a, b) for a in range(len(nodes)) for b in range(a + 1, len(nodes))]
    near = [(a, b) for a, b in pairs if math.dist(at(a, columns), at(b, columns)) < 1.5]
    return MapGraph(nodes, [edge(a, b, columns) for a, b in near])


def claim(x_m, y_m, similarity=90, yaw_rad=0.0):
    """A node seen at this place, from a camera that looks along x."""
    away_m = math.hypot(x_m, y_m)
    heading_rad = math.atan2(y_m, x_m) if away_m > 0.1 else None
    return Claim(similarity, heading_rad, 0.01, yaw_rad, away_m)
