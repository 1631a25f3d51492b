"""Which nodes the robot can start from, by a frame compared with the map. Pure."""

from collections.abc import Callable, Collection, Mapping
from functools import partial

from services.planner.ports import Matches
from services.planner.profiles import Profile
from services.planner.similarity import ranked, similarity, tells_place, trusted
from services.planner.surroundings import is_clear, length_m
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.keep_clear import clear_nodes, keep_clear
from shared.mapgraph.routing import HOP_M, UNSEEN_GROUND, EdgeCost, fewest_crossable, way_m
from shared.mapgraph.rules import Limits
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

LESS_SIMILAR_NODES = 1e6
"""Nodes that a path may have more to go from a more similar start; chosen: more than any has."""


def starts_in_sight(matches: Matches, graph: MapGraph, ranges: Ranges, profile: Profile) -> dict[int, float]:
    """Nodes that the robot can drive to from here, with the cost of the way there.

    The thesis sets out from the most similar one (section 4.1): the next comes where no way leads on from it.
    """
    if profile.travel.path_cost == "nodes":
        similar = _similar(matches, profile, profile.travel.s_via_min)
        return {node: LESS_SIMILAR_NODES * rank for rank, node in enumerate(similar)}
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
        return dict.fromkeys(_similar(matches, profile, s_min)[:1], 0.0)
    return {
        node: (1.0 if node in clear else UNSEEN_GROUND) * length_m(match, graph) + HOP_M
        for node, match in matches.items()
        if similarity(match, profile) > s_min and tells_place(match, graph, profile)
    }


def allowed_starts(
    visible: Mapping[int, float], graph: MapGraph, here: Displacement | None, limits: Limits
) -> dict[int, float]:
    """Nodes in sight that the rules let a robot go to from here: not through a keep-out, if any other way is.

    Args:
        visible: nodes with the cost of the way there.
        graph: the map.
        here: where the robot is; None where nobody knows.
        limits: what the rules say.
    """
    allowed = {node: cost for node, cost in visible.items() if node not in limits.forbidden}
    clear = clear_nodes(graph, here, allowed, limits.forbidden)
    nearest = sorted(allowed, key=lambda node: (allowed[node], node))[:1]
    return {node: allowed[node] for node in clear or nearest}


def allowed_targets(
    wanted: Mapping[int, float],
    graph: MapGraph,
    lies: Callable[[int], Displacement | None],
    limits: Limits,
) -> dict[int, float]:
    """Nodes from which the rules let a robot go on to the goal.

    Args:
        wanted: nodes to reach, with the cost of the way beyond.
        graph: the map.
        lies: where the goal picture was taken relative to a node, as far as that is known.
        limits: what the rules say.
    """

    def is_allowed(node: int) -> bool:
        goal = lies(node)
        if goal is None or node in limits.forbidden:
            return node not in limits.forbidden
        around = keep_clear(graph, node, limits.forbidden)
        return around is None or not around.is_crossed((0.0, 0.0), (goal.x_m, goal.y_m))

    if not limits.forbidden:
        return dict(wanted)
    return {node: cost for node, cost in wanted.items() if is_allowed(node)}


def in_sight(match: NodeMatch, graph: MapGraph, ranges: Ranges, profile: Profile) -> bool:
    """Whether a goal picture is recognised over free ground, so that no path is needed."""
    clear = trusted(match, profile) and is_clear(match, graph, ranges, profile)
    return clear and similarity(match, profile) > profile.mapping.s_edge_min


def edge_cost(graph: MapGraph, profile: Profile) -> EdgeCost:
    """The cost of an edge by the profile."""
    if profile.travel.path_cost == "nodes":
        return partial(fewest_crossable, similarity_min=profile.mapping.s_edge_min)
    return partial(way_m, graph)


def _similar(matches: Matches, profile: Profile, s_min: int) -> list[int]:
    """Nodes of more similarity than that, most similar first."""
    return [node for node, match in ranked(matches, profile) if similarity(match, profile) > s_min]
