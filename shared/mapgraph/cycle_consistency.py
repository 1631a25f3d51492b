"""Which nodes that a frame resembles fit with one another: the edges between them judge. Pure.

Perceptual aliasing gives matches that fit one motion of the camera towards a wrong node. A neighbour of that
node must then fit as well: in the triangle of frame, node and neighbour the yaws add up and the bearings can
close. A neighbour seen in the same frame whose triangle closes supports the node, one whose does not
contradicts it.
"""

from collections.abc import Callable, Mapping, Set
from typing import Any, TypeVar

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.triangle import Sight, triangle_closes
from shared.messages.matching import NodeMatch

K = TypeVar("K")

NEAR_HOPS = 1
"""Within so many edges of the node the robot came from an edge closes no loop."""


def unsupported_loop_closures(
    graph: MapGraph, matches: Mapping[int, NodeMatch], driven_from: int | None
) -> dict[int, str]:
    """Nodes far from where the robot came from that no neighbour of theirs supports.

    Args:
        graph: the map without the new node.
        matches: trusted matches of the new frame that would become edges.
        driven_from: node the robot came from; None (the first node, or carried) asks for no support.

    Returns:
        Node and reason.
    """
    if driven_from is None or driven_from not in graph.nodes:
        return {}
    near = graph.within(driven_from, NEAR_HOPS)
    refused = {}
    for node in sorted(set(matches) - near):
        seen = [n for n in graph.neighbours(node) if n in matches]
        if not any(is_consistent(graph, matches, node, neighbour) for neighbour in seen):
            refused[node] = f"{len(seen)} neighbours of node {node} seen, none agrees"
    return refused


def supported_by(graph: MapGraph, matches: Mapping[int, NodeMatch], sure: Set[int]) -> set[int]:
    """Nodes of `matches` that a neighbour among the sure ones supports, or one so supported.

    Args:
        graph: the map.
        matches: trusted matches of the current frame.
        sure: nodes known to be in sight.

    Returns:
        The nodes, without the sure ones.
    """
    known, waiting = set(sure), sorted(set(sure))
    while waiting:
        neighbour = waiting.pop()
        for node in graph.neighbours(neighbour):
            if node in matches and node not in known and is_consistent(graph, matches, node, neighbour):
                known.add(node)
                waiting.append(node)
    return known - sure


def contradicted(
    graph: MapGraph, matches: Mapping[int, NodeMatch], voters: Mapping[int, NodeMatch] | None = None
) -> dict[int, str]:
    """Nodes that their neighbours in the map outvote, weakest case first.

    A wall whose pattern repeats gives a clear motion in a wrong direction; nodes seen beside it tell. Every
    pair of matched nodes with an edge between them agrees or not; a vote weighs as many inliers as the voter
    has.

    Args:
        graph: the map.
        matches: the nodes to judge.
        voters: all nodes whose matches count, also those too ambiguous for an edge; None: only the judged.

    Returns:
        Node and reason.
    """
    votes = _votes(graph, matches, voters if voters is not None else matches)
    against = outvoted(votes, least=0, order=lambda node: node)
    return {
        node: f"{-balance} more matches of its neighbours speak against node {node}"
        for node, balance in against.items()
    }


def outvoted(votes: Mapping[K, Mapping[K, int]], least: int, order: Callable[[K], Any]) -> dict[K, int]:
    """Those who get less than `least` votes once others with less are gone, weakest first.

    Args:
        votes: by who is judged, those who judge and how many votes they give, negative against.
        least: balance of votes with which one stays.
        order: who goes first of those with the same balance.

    Returns:
        Their balances.
    """
    balance = {one: sum(given.values()) for one, given in votes.items()}
    gone: dict[K, int] = {}
    while balance:
        worst = min(balance, key=lambda one: (balance[one], order(one)))
        if balance[worst] >= least:
            break
        gone[worst] = balance.pop(worst)
        for one in balance:
            balance[one] -= votes[one].get(worst, 0)
    return gone


def _votes(
    graph: MapGraph, matches: Mapping[int, NodeMatch], voters: Mapping[int, NodeMatch]
) -> dict[int, dict[int, int]]:
    """For each node the neighbours that can judge it: their inliers, negative against it."""
    seen = {**voters, **matches}
    return {
        node: {
            neighbour: seen[neighbour].inliers * (1 if is_consistent(graph, seen, node, neighbour) else -1)
            for neighbour in graph.neighbours(node)
            if neighbour in seen and _can_judge(graph, seen, node, neighbour)
        }
        for node in sorted(matches)
    }


def _can_judge(graph: MapGraph, matches: Mapping[int, NodeMatch], node: int, neighbour: int) -> bool:
    yaws = matches[node].yaw_rad, matches[neighbour].yaw_rad
    return graph.sight(node, neighbour) is not None and None not in yaws


def is_consistent(graph: MapGraph, matches: Mapping[int, NodeMatch], node: int, neighbour: int) -> bool:
    """Whether the triangle of frame, node and neighbour closes."""
    onward, to_node, to_neighbour = graph.sight(node, neighbour), matches[node], matches[neighbour]
    return onward is not None and triangle_closes(
        Sight(to_node.heading_rad, to_node.yaw_rad),
        Sight(to_neighbour.heading_rad, to_neighbour.yaw_rad),
        onward,
    )
