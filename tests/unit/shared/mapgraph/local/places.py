"""Rows of nodes that the robot drove along, in a room and in a street."""

import itertools

from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node


def inliers_at(distance_m, carries_m, keypoints=300):
    """Matches of two pictures so far apart where half of them are lost after `carries_m`."""
    return round(0.9 * keypoints / (1.0 + distance_m / carries_m))


def row(count, carries_m, first=0, spacing_m=0.7, keypoints=300):
    """Nodes and edges along a line, driven from one to the next."""
    nodes = [Node(node_id=first + k, keypoints=keypoints) for k in range(count)]
    inliers = inliers_at(spacing_m, carries_m, keypoints)
    edges = [
        Edge(a=a.node_id, b=b.node_id, inliers=inliers, length_m=spacing_m, traversals=1)
        for a, b in itertools.pairwise(nodes)
    ]
    return nodes, edges


ROOM, STREET = MapGraph(*row(10, 0.32)), MapGraph(*row(10, 0.6))
