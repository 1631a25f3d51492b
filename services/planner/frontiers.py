"""Frontiers without metres: twelve directions a node, open by sensor, explored by edges and departures."""

import math

from services.planner.graph import MapGraph
from services.planner.profiles import Profile
from shared.messages.base import SECTORS
from shared.messages.maps import Node

SECTOR_RAD = math.tau / SECTORS
NEARER = 1.5
"""A place this much more similar is so near that it covers the directions beside it, too."""


def sector_rad(sector: int) -> float:
    """Centre of a sector in the node's camera frame."""
    return math.remainder(sector * SECTOR_RAD, math.tau)


def with_explored(node: Node, graph: MapGraph, profile: Profile) -> Node:
    """The node with the sectors explored that edges to near places cover.

    Args:
        node: the place.
        graph: the map around it.
        profile: the similarity an edge needs (to a less similar place there is unexplored ground in between),
            and how wide a direction it covers.
    """
    explored = list(node.explored)
    for neighbour in graph.neighbours(node.node_id):
        edge, heading = graph.edge(node.node_id, neighbour), graph.heading(node.node_id, neighbour)
        if edge is None or heading is None or edge.inliers < profile.s_explored:
            continue
        near = edge.inliers > NEARER * profile.s_explored
        half_rad = profile.near_half_rad if near else profile.explored_half_rad
        if not edge.clear:
            half_rad = min(half_rad, profile.blind_half_rad)
        for sector in range(SECTORS):
            if abs(math.remainder(sector_rad(sector) - heading, math.tau)) < half_rad:
                explored[sector] = True
    return node.model_copy(update={"explored": tuple(explored)})


def mark_explored(node: Node, sector: int) -> Node:
    """The node with one more direction explored."""
    explored = tuple(known or index == sector for index, known in enumerate(node.explored))
    return node.model_copy(update={"explored": explored})


def frontier_sectors(node: Node) -> list[int]:
    """Open directions nobody has explored."""
    return [s for s in range(SECTORS) if node.open[s] and not node.explored[s]]


def best_sector(node: Node, preferred_rad: float) -> int | None:
    """The frontier sector nearest to a direction in the node's frame; the lower number when equal."""
    sectors = frontier_sectors(node)
    return min(
        sectors,
        key=lambda s: (round(abs(math.remainder(sector_rad(s) - preferred_rad, math.tau)), 6), s),
        default=None,
    )


def open_directions(graph: MapGraph) -> int:
    """How many frontiers the whole map has."""
    return sum(len(frontier_sectors(node)) for node in graph.nodes.values())
