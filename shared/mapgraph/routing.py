"""Cheapest paths through the map (thesis section 4.1, Dijkstra). Pure."""

import math
from collections.abc import Callable, Collection, Mapping

import networkx as nx

from shared.mapgraph.graph import EdgeKey, MapGraph, edge_key
from shared.mapgraph.local.view_range import edge_length_m
from shared.mapgraph.rules import NO_LIMITS, Limits
from shared.messages.maps import Edge

EdgeCost = Callable[[Edge], float]

GOAL = -1
"""Node id of a goal picture, as matches report it and as the last element of a path."""

UNSEEN_GROUND = 6.0
"""Ground nobody has driven or seen free counts this much more: furniture may stand there (decision 0004)."""

HOP_M = 0.2
"""Added per edge, so that of equally long paths the one with fewer nodes wins; chosen: a third of an edge."""

FAILURE_M = 2.0
"""Added per failure of an edge; chosen: a way round a piece of furniture is preferred."""

SUSPENDED_M = 1000.0
"""Cost of an edge that experience speaks against: more than a path across any map, so the last resort."""

UNCROSSABLE_NODES = 100.0
"""Nodes that a path may have more without an edge that is none to the thesis; chosen: more than paths have in
a village."""

UNCLEAR_M = 12.0
"""Added to an edge along which no free ground was seen: a detour of so many metres is preferred; chosen."""


def fewest_nodes(edge: Edge) -> float:
    """The thesis's cost: every edge counts one (section 4.1)."""
    return 1.0 + SUSPENDED_M * edge.suspended


def fewest_crossable(edge: Edge, similarity_min: int) -> float:
    """The same for a map that other rules may have made.

    To the thesis an edge is a crossable path (section 1.1) of more than `similarity_min` matches (equation
    4.1). One over ground that nobody saw free, or of fewer, comes after all that are.
    """
    crossable = edge.raw_matches > similarity_min and _is_free(edge)
    return fewest_nodes(edge) + (0.0 if crossable else UNCROSSABLE_NODES)


def way_m(graph: MapGraph, edge: Edge) -> float:
    """Length of an edge in metres, with what speaks against it; prefers edges driven or seen free."""
    trust = 1.0 if _is_free(edge) else UNSEEN_GROUND
    failed_m = FAILURE_M * edge.failures + SUSPENDED_M * edge.suspended
    return trust * edge_length_m(graph, edge) + HOP_M + failed_m


def plan_path(
    graph: MapGraph,
    starts: Mapping[int, float],
    targets: Mapping[int, float],
    edge_cost: EdgeCost,
    unclear: Collection[EdgeKey] = (),
    banned: Collection[EdgeKey] = (),
    limits: Limits = NO_LIMITS,
) -> list[int]:
    """Cheapest node sequence from any start to any target; empty when there is none.

    Args:
        graph: the map.
        starts: nodes in sight, with the cost of the way there.
        targets: nodes to reach, with the cost of the way beyond.
        edge_cost: of an edge of the map.
        unclear: edges on which no free ground was seen; (GOAL, node) is the way from a node to the goal.
        banned: edges not to be tried.
        limits: nodes that no path enters, ways that none takes, and slow ones, which cost as much more.
    """

    def cost(edge: Edge) -> float:
        return edge_cost(edge) + UNCLEAR_M * ((edge.a, edge.b) in unclear)

    beyond = {n: more + UNCLEAR_M * (edge_key(GOAL, n) in unclear) for n, more in targets.items()}
    to_go, paths = _to_targets(open_ways(graph, cost, banned, limits), beyond)
    reachable = [(there + to_go[node], node) for node, there in starts.items() if node in to_go]
    return paths[min(reachable)[1]] if reachable else []


def metres_to(graph: MapGraph, node_id: int, limits: Limits = NO_LIMITS) -> dict[int, float]:
    """Length of the shortest way from every node to one of them, metres; of those from which one leads.

    Ways that experience speaks against count `SUSPENDED_M` more, slow ones by how much longer they take.
    """

    def length_m(edge: Edge) -> float:
        return edge_length_m(graph, edge) + SUSPENDED_M * edge.suspended

    return _to_targets(open_ways(graph, length_m, (), limits), {node_id: 0.0})[0]


def open_ways(
    graph: MapGraph, edge_cost: EdgeCost, banned: Collection[EdgeKey], limits: Limits
) -> "nx.Graph[int]":
    """The nodes that may be entered and the ways between them, with what each costs as its weight.

    Directed from here to there where some way is closed in one direction. An edge of infinite cost is no way.
    The arguments are those of `plan_path`.
    """
    ways: nx.Graph[int] = nx.DiGraph() if limits.closed else nx.Graph()
    allowed = graph.nodes.keys() - limits.forbidden.keys()
    ways.add_nodes_from(sorted(allowed))
    for (a, b), edge in sorted(graph.edges.items()):
        cost = math.inf if (a, b) in banned else edge_cost(edge)
        if cost == math.inf or not {a, b} <= allowed:
            continue
        for here, there in ((a, b), (b, a)):
            if (here, there) not in limits.closed:
                ways.add_edge(here, there, weight=cost / limits.speed_share(here, there))
    return ways


def _is_free(edge: Edge) -> bool:
    """Whether somebody has driven along an edge or seen free ground there."""
    return edge.clear or edge.traversals > 0


def _to_targets(
    ways: "nx.Graph[int]", targets: Mapping[int, float]
) -> tuple[dict[int, float], dict[int, list[int]]]:
    """Cost and path from every node to its cheapest target, searched from the goal back.

    The goal joins `ways`, which nobody else reads: a copy would take as long as building them.
    """
    back = ways.reverse() if isinstance(ways, nx.DiGraph) else ways
    for node_id, extra in sorted(targets.items()):
        if node_id in back:
            back.add_edge(GOAL, node_id, weight=extra)
    if GOAL not in back:
        return {}, {}
    costs: dict[int, float]
    paths: dict[int, list[int]]
    costs, paths = nx.single_source_dijkstra(back, GOAL)  # type: ignore[assignment]
    reached = [node for node in paths if node != GOAL]
    return {n: costs[n] for n in reached}, {n: list(reversed(paths[n][1:])) for n in reached}
