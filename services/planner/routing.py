"""Localisation and path planning (thesis section 4.1): from what is seen now to what the goal resembles."""

from collections.abc import Mapping

from services.planner.graph import EdgeCost, MapGraph, fewest_nodes, least_disparity
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity, trusted
from shared.messages.matching import NodeMatch

UNKNOWN_DISPARITY_RAD = 0.5
HOP_RAD = 0.03
FIRST_LEG = 1.3
"""A leg to a place that is only seen, never driven, counts this much more."""


def edge_cost(profile: Profile) -> EdgeCost:
    """The cost of the profile."""
    return fewest_nodes if profile.path_cost == "nodes" else least_disparity


def visible(matches: Mapping[int, NodeMatch], profile: Profile, s_min: int) -> dict[int, float]:
    """Places similar enough to drive to, with the cost of the leg there."""
    if profile.path_cost == "nodes":
        best = ranked(dict(matches), profile)[:1]
        return {node: 0.0 for node, match in best if similarity(match, profile) > s_min}
    return {
        node: _leg(match)
        for node, match in matches.items()
        if similarity(match, profile) > s_min and trusted(match, profile)
    }


def plan_path(
    graph: MapGraph, starts: Mapping[int, float], targets: Mapping[int, float], profile: Profile
) -> list[int]:
    """Cheapest node sequence from any start to any target; empty when there is none."""
    cost = edge_cost(profile)
    to_go = graph.costs_to(targets, cost)
    reachable = [(leg + to_go[node], node) for node, leg in starts.items() if node in to_go]
    if not reachable:
        return []
    return graph.path(min(reachable)[1], targets, cost)


def _leg(match: NodeMatch) -> float:
    disparity = match.disparity_rad if match.disparity_rad is not None else UNKNOWN_DISPARITY_RAD
    return FIRST_LEG * disparity + HOP_RAD
