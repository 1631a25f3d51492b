"""Which nodes the robot can start from, by a frame compared with the map. Pure."""

from collections.abc import Collection
from functools import partial

from services.planner.ports import Matches
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity, tells_place, trusted
from services.planner.surroundings import is_clear, length_m
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import HOP_M, UNSEEN_GROUND, EdgeCost, fewest_nodes, way_m
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges


def starts_in_sight(matches: Matches, graph: MapGraph, ranges: Ranges, profile: Profile) -> dict[int, float]:
    """Nodes that the robot can drive to from here, with the cost of the way there."""
    clear = {node for node, match in matches.items() if is_clear(match, graph, ranges, profile)}
    return reachable_nodes(matches, graph, profile, profile.travel.s_via_min, clear)


def reachable_nodes(
    matches: Matches, graph: MapGraph, profile: Profile, s_min: int, clear: Collection[int]
) -> dict[int, float]:
    """Nodes similar enough to a picture to drive to or from, with the cost of the way in between.

    Args:
        matches: the picture against the map.
        graph: the map.
        profile: thresholds and kind of cost.
        s_min: similarity needed.
        clear: nodes with free ground in between.
    """
    if profile.travel.path_cost == "nodes":
        best = ranked(matches, profile)[:1]
        return {node: 0.0 for node, match in best if similarity(match, profile) > s_min}
    return {
        node: (1.0 if node in clear else UNSEEN_GROUND) * length_m(match, graph) + HOP_M
        for node, match in matches.items()
        if similarity(match, profile) > s_min and tells_place(match, graph, profile)
    }


def in_sight(match: NodeMatch, graph: MapGraph, ranges: Ranges, profile: Profile) -> bool:
    """Whether a goal picture is recognised over free ground, so that no path is needed."""
    clear = trusted(match, profile) and is_clear(match, graph, ranges, profile)
    return clear and similarity(match, profile) > profile.mapping.s_edge_min


def edge_cost(graph: MapGraph, profile: Profile) -> EdgeCost:
    """The cost of an edge by the profile."""
    return fewest_nodes if profile.travel.path_cost == "nodes" else partial(way_m, graph)
