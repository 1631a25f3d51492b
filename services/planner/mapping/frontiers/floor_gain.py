"""Which directions of nodes are worth the way: those that lead to floor that no node around covers. Pure."""

import math
from collections.abc import Sequence
from functools import reduce

import numpy as np

from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.frontiers.new_floor import ROOM_COVERS_M, Neighbourhood
from services.planner.profiles import Profile
from services.planner.surroundings import free_ways_m
from shared.mapgraph.frontiers import mark_explored, sector_rad
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.view_range import openness
from shared.messages.maps import Node
from shared.messages.sensors import Ranges

STRAIGHT_SHARE = 0.25
"""Share of its gain that a direction loses which turns the robot round; chosen: of two that are as good the
one ahead comes first."""


def without_poor_directions(graph: MapGraph, root: int, profile: Profile, views: FloorViews) -> list[Node]:
    """Nodes around one that have less to explore than they say: what lies there is known.

    Args:
        graph: the map.
        root: the node just added.
        profile: how far a node covers, and the share of that which a new one must add.
        views: what was seen from the nodes; gets what their directions lead to.

    Returns:
        Those nodes, with the directions explored that are not worth the way.
    """
    covers_m = covered_m(graph, root, profile)
    if not covers_m:
        return []
    around = Neighbourhood(graph, root, covers_m, views)
    changed = []
    for node in around.nodes():
        gains = around.gains(node)
        if gains:
            views.gains[node.node_id] = max(gains.values())
        poor = [sector for sector, gain in gains.items() if gain < profile.mapping.gain_min]
        if poor:
            changed.append(reduce(mark_explored, poor, node))
    return changed


def covered_m(graph: MapGraph, node_id: int, profile: Profile) -> float:
    """How far around a node floor counts as known; 0 where every direction is to be explored."""
    if profile.mapping.covers_m is not None:
        return profile.mapping.covers_m
    return ROOM_COVERS_M * openness(graph, node_id)


def best_sector(
    graph: MapGraph,
    node_id: int,
    sectors: Sequence[int],
    preferred_rad: float,
    profile: Profile,
    views: FloorViews,
) -> int | None:
    """The direction of a node with most new floor, rather about a preferred one; None without any.

    Args:
        graph: the map.
        node_id: the node.
        sectors: its unexplored directions to choose from.
        preferred_rad: where the robot goes already, in the node's camera frame.
        profile: how far a node covers.
        views: what was seen from the nodes.
    """

    def worth(sector: int) -> tuple[float, int]:
        turn_rad = abs(math.remainder(sector_rad(sector) - preferred_rad, math.tau))
        return round(gains[sector] * (1.0 - STRAIGHT_SHARE * turn_rad / math.pi), 6), -sector

    covers_m = covered_m(graph, node_id, profile)
    gains = dict.fromkeys(sectors, 1.0)
    if covers_m and sectors:
        gains = Neighbourhood(graph, node_id, covers_m, views).gains(graph.nodes[node_id])
    return max(sectors, key=worth, default=None)


def gain_here(
    graph: MapGraph, here: Displacement, ranges: Ranges, profile: Profile, views: FloorViews
) -> float:
    """New floor around the robot, which no node covers; 0 where every direction is to be explored.

    Args:
        graph: the map.
        here: where the robot is.
        ranges: the distances here.
        profile: how far a node covers.
        views: what was seen from the nodes, and on the way here.
    """
    covers_m = covered_m(graph, here.node_id, profile)
    if not covers_m:
        return 0.0
    around = Neighbourhood(graph, here.node_id, covers_m, views)
    return around.gain_here(here, np.array(free_ways_m(ranges, profile)))
