"""Which nodes the robot can start from, by a frame compared with the map. Pure."""

from collections.abc import Collection

from services.planner.ports import Matches
from services.planner.profiles import Profile
from services.planner.similarity import apart_rad, ranked, similarity, tells_place, trusted
from services.planner.surroundings import is_clear
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
        if similarity(match, profile) > s_min and tells_place(match, profile)
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
