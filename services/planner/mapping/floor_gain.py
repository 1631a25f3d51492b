"""How much floor a direction of a node leads to that no node around covers. Pure."""

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from services.planner.profiles import Profile
from shared.mapgraph.frontiers import SECTOR_RAD, frontier_sectors, mark_explored
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.relative_poses import RelativePose, relative_poses
from shared.mapgraph.local.sights import metres_per_rad
from shared.messages.base import SECTORS
from shared.messages.maps import Edge, Node

FloatArray = npt.NDArray[np.float64]
ACROSS = 13
"""Points across the disc that a node covers; chosen: 130 in all, so that 1 % of it counts."""
OCCLUDED = 0.25
"""What floor behind an obstacle counts: there may be a way round it, or none; chosen."""
HOPS = 3
"""Edges over free ground to nodes whose floor is on the same side of every wall; chosen: 2 to 3 m."""


def without_poor_directions(graph: MapGraph, root: int, profile: Profile) -> list[Node]:
    """Nodes around one that have less to explore than they say: what lies there is known.

    Args:
        graph: the map.
        root: the node just added.
        profile: how far a node covers, and the share of that which a new one must add.

    Returns:
        Those nodes, with the directions explored that are not worth the way.
    """
    covers_m = profile.mapping.covers_m
    if not covers_m:
        return []
    scale = metres_per_rad(graph, 1.0 / profile.sensing.disparity_rad_per_m)
    poses = relative_poses(graph, root, graph.nearest(root, NEAR_NODES), scale, NEAR_NODES)
    near = [n for n, pose in poses.items() if np.linalg.norm(pose.position_m) < 3.0 * covers_m]
    looked = [_without_poor(graph, poses, graph.nodes[node_id], profile) for node_id in near]
    return [node for node in looked if node != graph.nodes[node.node_id]]


def _without_poor(graph: MapGraph, poses: Mapping[int, RelativePose], node: Node, profile: Profile) -> Node:
    """The node with the directions explored in which too little floor is new."""
    sectors = frontier_sectors(node)
    if not sectors:
        return node
    known_m = np.array([poses[n].position_m for n in _on_this_side(graph, node.node_id) if n in poses])
    for sector in sectors:
        if (
            _gain(known_m, poses[node.node_id], node, sector, profile.mapping.covers_m)
            < profile.mapping.gain_min
        ):
            node = mark_explored(node, sector)
    return node


def _gain(known_m: FloatArray, own: RelativePose, node: Node, sector: int, covers_m: float) -> float:
    """Share of the disc around the next spot in a direction which no node covers.

    Args:
        known_m: (N, 2) of the nodes on this side of the walls, in one frame.
        own: pose of the node in that frame.
        node: that the direction belongs to.
        sector: the direction.
        covers_m: radius of the disc, metres.
    """
    free_m = np.array(node.free_m or [covers_m] * SECTORS)
    angle_rad, ahead_m = own.yaw_rad + sector * SECTOR_RAD, min(covers_m, free_m[sector])
    floor = (
        own.position_m + ahead_m * np.array([math.cos(angle_rad), math.sin(angle_rad)]) + covers_m * _disc()
    )
    gaps = np.linalg.norm(floor[:, None] - known_m[None], axis=2)
    new = floor[(gaps > covers_m).all(axis=1)]
    return float(_weights(new, own, free_m).sum()) / len(floor)


def _weights(floor: FloatArray, own: RelativePose, free_m: FloatArray) -> FloatArray:
    """1 for floor that the sensors saw from the node, less behind what they saw."""
    offset = floor - own.position_m
    bearing_rad = np.arctan2(offset[:, 1], offset[:, 0]) - own.yaw_rad
    sector = np.rint(bearing_rad / SECTOR_RAD).astype(int) % SECTORS
    return np.where(np.linalg.norm(offset, axis=1) <= free_m[sector], 1.0, OCCLUDED)


def _on_this_side(graph: MapGraph, start: int) -> set[int]:
    """Nodes that free ground joins to one, itself among them."""
    reached = {start}
    for _ in range(HOPS):
        beside = {(node, other) for node in reached for other in graph.neighbours(node)}
        reached |= {other for node, other in beside if _is_free(graph.edge(node, other))}
    return reached


def _is_free(edge: Edge | None) -> bool:
    return edge is not None and (edge.clear or edge.traversals > 0)


def _disc() -> FloatArray:
    """Points spread evenly over the unit disc."""
    side = np.linspace(-1.0, 1.0, ACROSS)
    x, y = np.meshgrid(side, side)
    inside = np.hypot(x, y) <= 1.0
    return np.stack([x[inside], y[inside]], axis=1)
