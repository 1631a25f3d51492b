"""Cheapest paths through the map (thesis section 4.1, Dijkstra). Pure."""

import math
from collections.abc import Callable, Collection, Mapping

import networkx as nx

from shared.mapgraph.graph import EdgeKey, MapGraph, edge_key
from shared.messages.maps import Edge

EdgeCost = Callable[[Edge], float]

GOAL = -1
"""Node id of a goal picture, as matches report it and as the last element of a path."""

UNSEEN_GROUND = 6.0
"""Ground nobody has driven or seen free counts this much more: furniture may stand there (decision 0004)."""

UNKNOWN_DISPARITY_RAD = 0.5
"""Disparity of an edge that has none: 29 degrees, that of nodes 5 m apart indoors (`topnav study
heading-frames`)."""

HOP_RAD = 0.03
"""Added per edge, so that of equally long paths the one with fewer nodes wins: 1.7 degrees, 0.2 m indoors."""

FAILURE_RAD = 0.3
"""Added per failure: an edge driven in vain costs two metres more, by 9 degrees of disparity a metre."""

SUSPENDED_RAD = 20.0
"""Cost of an edge that experience speaks against: more than a path across any map, so the last resort."""

UNCLEAR_RAD = 2.0
"""Added to an edge along which no free ground was seen: a detour of some ten metres is preferred."""


def fewest_nodes(edge: Edge) -> float:
    """The thesis's cost: every edge counts one (section 4.1)."""
    return SUSPENDED_RAD if edge.suspended else 1.0


def least_disparity(edge: Edge, least_rad: float = 0.0) -> float:
    """Sum of angular disparities, each at least `least_rad`; prefers edges driven or seen free."""
    measured_rad = edge.disparity_rad if edge.disparity_rad is not None else UNKNOWN_DISPARITY_RAD
    trust = 1.0 if edge.traversals or edge.clear else UNSEEN_GROUND
    failed_rad = FAILURE_RAD * edge.failures + SUSPENDED_RAD * edge.suspended
    return trust * max(least_rad, measured_rad) + HOP_RAD + failed_rad


def plan_path(
    graph: MapGraph,
    starts: Mapping[int, float],
    targets: Mapping[int, float],
    edge_cost: EdgeCost,
    unclear: Collection[EdgeKey] = (),
    banned: Collection[EdgeKey] = (),
) -> list[int]:
    """Cheapest node sequence from any start to any target; empty when there is none.

    Args:
        graph: the map.
        starts: nodes in sight, with the cost of the way there.
        targets: nodes to reach, with the cost of the way beyond.
        edge_cost: of an edge of the map.
        unclear: edges on which no free ground was seen; (GOAL, node) is the way from a node to the goal.
        banned: edges not to be tried.
    """

    def cost(edge: Edge) -> float:
        key = (edge.a, edge.b)
        return math.inf if key in banned else edge_cost(edge) + UNCLEAR_RAD * (key in unclear)

    beyond = {n: more + UNCLEAR_RAD * (edge_key(GOAL, n) in unclear) for n, more in targets.items()}
    to_go, paths = _to_targets(graph, beyond, cost)
    reachable = [(there + to_go[node], node) for node, there in starts.items() if node in to_go]
    return paths[min(reachable)[1]] if reachable else []


def _to_targets(
    graph: MapGraph, targets: Mapping[int, float], cost: EdgeCost
) -> tuple[dict[int, float], dict[int, list[int]]]:
    """Cost and path from every node to its cheapest target; an edge of infinite cost is not used."""
    weighted: nx.Graph[int] = nx.Graph()
    weighted.add_nodes_from(sorted(graph.nodes))
    for (a, b), edge in sorted(graph.edges.items()):
        if (weight := cost(edge)) < math.inf:
            weighted.add_edge(a, b, weight=weight)
    for node_id, extra in sorted(targets.items()):
        if node_id in graph.nodes:
            weighted.add_edge(node_id, GOAL, weight=extra)
    if GOAL not in weighted:
        return {}, {}
    costs: dict[int, float]
    paths: dict[int, list[int]]
    costs, paths = nx.single_source_dijkstra(weighted, GOAL)  # type: ignore[assignment]
    reached = [node for node in graph.nodes if node in paths]
    return {n: costs[n] for n in reached}, {n: list(reversed(paths[n][1:])) for n in reached}
