"""Localisation and path planning (thesis section 4.1): from what is seen now to what the goal resembles."""

import math
from collections.abc import Collection, Mapping

from services.planner.graph import UNSEEN_GROUND, EdgeCost, MapGraph, fewest_nodes, least_disparity
from services.planner.ports import GOAL
from services.planner.profiles import Profile
from services.planner.similarity import apart_rad, ranked, similarity, trusted
from shared.messages.maps import Edge
from shared.messages.matching import NodeMatch

UNKNOWN_DISPARITY_RAD = 0.5
HOP_RAD = 0.03
DOUBT_RAD = 2.0


def edge_cost(profile: Profile) -> EdgeCost:
    """The cost of the profile."""
    if profile.path_cost == "nodes":
        return fewest_nodes
    return lambda edge: least_disparity(edge, apart_rad(0.0, edge.inliers, profile))


def visible(
    matches: Mapping[int, NodeMatch], profile: Profile, s_min: int, clear: Collection[int]
) -> dict[int, float]:
    """Places similar enough to drive to, with the cost of the leg there.

    Args:
        matches: the picture against the map.
        profile: thresholds and kind of cost.
        s_min: similarity needed.
        clear: places with free ground in between.
    """
    if profile.path_cost == "nodes":
        best = ranked(dict(matches), profile)[:1]
        return {node: 0.0 for node, match in best if similarity(match, profile) > s_min}
    return {
        node: _leg(match, profile, clear=node in clear)
        for node, match in matches.items()
        if similarity(match, profile) > s_min and trusted(match, profile)
    }


def plan_path(
    graph: MapGraph,
    starts: Mapping[int, float],
    targets: Mapping[int, float],
    profile: Profile,
    doubted: Collection[tuple[int, int]] = (),
    banned: Collection[tuple[int, int]] = (),
) -> list[int]:
    """Cheapest node sequence from any start to any target; empty when there is none.

    Args:
        graph: the map.
        starts: nodes in sight, with the cost of the leg there.
        targets: nodes to reach, with the cost of the leg beyond.
        profile: kind of cost.
        doubted: legs on which no free ground was seen; taken only when there is hardly another way.
        banned: legs not to be tried.
    """
    base = edge_cost(profile)

    def cost(edge: Edge) -> float:
        if (edge.a, edge.b) in banned:
            return math.inf
        return base(edge) + DOUBT_RAD * ((edge.a, edge.b) in doubted)

    targets = {node: extra + DOUBT_RAD * ((GOAL, node) in doubted) for node, extra in targets.items()}
    to_go = graph.costs_to(targets, cost)
    reachable = [(leg + to_go[node], node) for node, leg in starts.items() if node in to_go]
    if not reachable:
        return []
    return graph.path(min(reachable)[1], targets, cost)


def _leg(match: NodeMatch, profile: Profile, *, clear: bool) -> float:
    disparity = match.disparity_rad if match.disparity_rad is not None else UNKNOWN_DISPARITY_RAD
    apart = apart_rad(disparity, match.inliers, profile)
    return (1.0 if clear else UNSEEN_GROUND) * apart + HOP_RAD
