"""Frontiers without metres: twelve directions a node, open by sensor, explored by edges. Pure."""

import math

from pydantic import BaseModel, ConfigDict, PositiveFloat, PositiveInt

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import edge_length_m
from shared.messages.base import SECTORS
from shared.messages.maps import Node

SECTOR_RAD = math.tau / SECTORS

NEARER = 1.5
"""A node this much more similar is so near that it covers the directions beside it, too: S falls from 132 at
0.4 m to 84 at 0.75 m (decision 0011)."""


class ExploredRules(BaseModel):
    """Which directions of a node an edge leaves nothing to explore in.

    Attributes:
        s_explored: S that the edge needs: to a less similar node there is unexplored ground in between.
        explored_half_rad: directions this near to the edge's are explored.
        near_half_rad: the same for a node NEARER times as similar.
        blind_half_rad: at most this where the sensors did not see free ground all along the edge.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    s_explored: PositiveInt = 45
    explored_half_rad: PositiveFloat = math.radians(28.0)
    near_half_rad: PositiveFloat = math.radians(36.0)
    blind_half_rad: PositiveFloat = math.radians(36.0)


def sector_rad(sector: int) -> float:
    """Centre of a sector in the node's camera frame."""
    return math.remainder(sector * SECTOR_RAD, math.tau)


def with_explored(
    node: Node,
    graph: MapGraph,
    rules: ExploredRules,
    longest_m: float = math.inf,
    covers_m: float = math.inf,
) -> Node:
    """The node with the sectors explored that its edges in `graph` cover.

    Beside an edge, a sector stays open in which the sensors saw so far beyond what its end covers that there
    is floor for another node: a door may be there, and a room behind it of which the end knows nothing.

    Args:
        node: of the map.
        graph: its edges.
        rules: what they cover.
        longest_m: a longer edge covers nothing.
        covers_m: how far around a node floor counts as known.
    """
    explored = list(node.explored)
    for neighbour in graph.neighbours(node.node_id):
        edge, heading = graph.edge(node.node_id, neighbour), graph.heading(node.node_id, neighbour)
        if edge is None or heading is None or edge.inliers < rules.s_explored:
            continue
        length_m = edge_length_m(graph, edge)
        if length_m > longest_m:
            continue
        near = edge.inliers > NEARER * rules.s_explored
        half_rad = rules.near_half_rad if near else rules.explored_half_rad
        if not edge.clear:
            half_rad = min(half_rad, rules.blind_half_rad)
        for sector in range(SECTORS):
            off_rad = abs(math.remainder(sector_rad(sector) - heading, math.tau))
            if off_rad >= half_rad:
                continue
            beside = off_rad > SECTOR_RAD / 2
            sees_on = node.free_m is not None and node.free_m[sector] > length_m + 2.0 * covers_m
            explored[sector] = explored[sector] or not (beside and sees_on)
    return node.model_copy(update={"explored": tuple(explored)})


def mark_explored(node: Node, sector: int) -> Node:
    """The node with one more direction explored."""
    explored = tuple(known or index == sector for index, known in enumerate(node.explored))
    return node.model_copy(update={"explored": explored})


def without_frontiers(node: Node) -> Node:
    """The node with nothing left to explore."""
    return node.model_copy(update={"explored": (True,) * SECTORS})


def frontier_sectors(node: Node) -> list[int]:
    """Open directions nobody has explored."""
    return [s for s in range(SECTORS) if node.open[s] and not node.explored[s]]


def open_directions(graph: MapGraph) -> int:
    """How many frontiers the whole map has."""
    return sum(len(frontier_sectors(node)) for node in graph.nodes.values())
