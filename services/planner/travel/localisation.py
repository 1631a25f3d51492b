"""Where the robot can be, and which nodes it can start from, by a frame compared with the map. Pure."""

from collections.abc import Collection

from services.planner.ports import Matches
from services.planner.profiles import Profile
from services.planner.similarity import apart_rad, ranked, similarity, trusted
from services.planner.surroundings import is_clear
from shared.mapgraph.cycle_consistency import FAR_HOPS
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import (
    HOP_RAD,
    UNKNOWN_DISPARITY_RAD,
    UNSEEN_GROUND,
    EdgeCost,
    fewest_nodes,
    least_disparity,
)
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges


def nodes_around(graph: MapGraph, matches: Matches, profile: Profile, last: int | None = None) -> set[int]:
    """The matched nodes of one part of the map: where the robot can be under perceptual aliasing.

    A robot does not jump: the part round the node it was last seen at counts, as long as one of its nodes
    resembles the view and it stands at no other node of the map. Without such a node the part counts whose
    nodes resemble the view most in all: beside the robot several do, each for itself; an aliased one
    elsewhere stands alone, or its neighbours fit less. Where `s_far` asks for no such care all is one part.

    Args:
        graph: the map.
        matches: the current frame against nodes of the map.
        profile: thresholds.
        last: where the robot was; None when it was lost or carried.
    """
    if not profile.mapping.s_far:
        return set(matches)
    seen = {
        node: similarity(match, profile)
        for node, match in matches.items()
        if node in graph.nodes
        and trusted(match, profile)
        and similarity(match, profile) > profile.travel.s_via_min
    }
    if last in graph.nodes and last is not None:
        near = graph.within(last, FAR_HOPS) & seen.keys()
        elsewhere = max((s for node, s in seen.items() if node not in near), default=0)
        if elsewhere < profile.mapping.s_far and any(
            seen[node] > profile.mapping.s_edge_min for node in near
        ):
            return near
    parts = [graph.within(node, FAR_HOPS) & seen.keys() for node in sorted(seen)]
    return max(parts, key=lambda part: sum(seen[node] for node in part), default=set())


def starts_in_sight(matches: Matches, ranges: Ranges, profile: Profile) -> dict[int, float]:
    """Nodes that the robot can drive to from here, with the cost of the way there."""
    clear = {node for node, match in matches.items() if is_clear(match, ranges, profile)}
    return reachable_nodes(matches, profile, profile.travel.s_via_min, clear)


def reachable_nodes(
    matches: Matches, profile: Profile, s_min: int, clear: Collection[int]
) -> dict[int, float]:
    """Nodes similar enough to a picture to drive to or from, with the cost of the way in between.

    Args:
        matches: the picture against the map.
        profile: thresholds and kind of cost.
        s_min: similarity needed.
        clear: nodes with free ground in between.
    """
    if profile.travel.path_cost == "nodes":
        best = ranked(matches, profile)[:1]
        return {node: 0.0 for node, match in best if similarity(match, profile) > s_min}
    return {
        node: _cost(match, profile, clear=node in clear)
        for node, match in matches.items()
        if similarity(match, profile) > s_min and trusted(match, profile)
    }


def in_sight(match: NodeMatch, ranges: Ranges, profile: Profile) -> bool:
    """Whether a goal picture is recognised over free ground, so that no path is needed."""
    clear = trusted(match, profile) and is_clear(match, ranges, profile)
    return clear and similarity(match, profile) > profile.mapping.s_edge_min


def edge_cost(profile: Profile) -> EdgeCost:
    """The cost of an edge by the profile."""
    if profile.travel.path_cost == "nodes":
        return fewest_nodes
    return lambda edge: least_disparity(edge, apart_rad(0.0, edge.inliers, profile))


def _cost(match: NodeMatch, profile: Profile, *, clear: bool) -> float:
    disparity = match.disparity_rad if match.disparity_rad is not None else UNKNOWN_DISPARITY_RAD
    apart = apart_rad(disparity, match.inliers, profile)
    return (1.0 if clear else UNSEEN_GROUND) * apart + HOP_RAD
