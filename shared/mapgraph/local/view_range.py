"""How far a view carries: the distance at which half of its matches are lost, learnt from driven edges. Pure.

Of the matches that a picture has at its very spot a share is left at distance d,

    share = 1 / (1 + d / h),

with one length h for each kind of place, whatever the distance: 0.32 m in a furnished flat, 0.38 m between
containers, 0.6 m in a street, 0.7 m in a factory (2000 pairs of frames 0.3 to 10 m apart, 300 keypoints; the
distance that follows is right to a factor of 1.5 for two in three, at all distances alike). Disparity, which
grows with distance too, is off by that factor within 1 m and by more than two beyond: in a corridor or a
street nearly all that two views share lies far ahead.
"""

import math
import statistics

from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge

ROOM_HALF_M = 0.32
"""In a furnished flat, the shortest of the places measured: a robot that knows nothing yet starts careful."""
FULL_SHARE = 0.9
"""Of its keypoints that a picture matches at its very spot."""
MOST_SHARE = 0.95
"""Of these matches: a share of all would mean that views carry without end."""
LEAST_M = 0.02
"""Nothing is nearer: matches are lost to noise as well."""
SHORTEST_M = 0.3
"""Driven edges that tell how far views carry are at least so long: noise takes as much as a shorter way."""
PRIOR_EDGES = 3
"""What is known of rooms counts as so many driven edges; chosen: a handful outweighs it."""
AROUND_NODES = 20
"""Nodes around one that say how far views carry there, nearest by edges first; chosen: a hall or a yard, not
the rooms beside it."""
SHORTEST_SHARE, LONGEST_SHARE = 0.5, 4.0
"""Views carry at least and at most so many times what they do in a room; chosen: far beyond all measured."""
KEYPOINTS = 300
"""Of a node that does not say how many it has: those of the default pipeline."""


def match_length_m(inliers: int, keypoints: int, half_m: float) -> float:
    """How far apart two pictures are that share so many matches.

    Args:
        inliers: verified matches.
        keypoints: of the pictures, the lesser number.
        half_m: distance at which half of the matches are lost.
    """
    share = min(1.0, max(inliers, 1) / max(FULL_SHARE * keypoints, 1.0))
    return max(LEAST_M, half_m * (1.0 / share - 1.0))


def half_told_m(length_m: float, inliers: int, keypoints: int) -> float:
    """The distance at which half of the matches are lost, as two pictures so far apart tell it."""
    share = min(MOST_SHARE, inliers / max(FULL_SHARE * keypoints, 1.0))
    return length_m * share / (1.0 - share) if share > 0.0 else math.inf


def half_m(graph: MapGraph, node_id: int | None = None) -> float:
    """Distance at which half of the matches are lost around a node; without one in the whole map."""
    known: dict[int | None, float] = graph.made_once("half of the matches", dict)
    where = node_id if node_id in graph.nodes else None
    if where not in known:
        near = None if where is None else graph.nearest(where, AROUND_NODES)
        told = [_told_by(graph, edge) for edge in _driven(graph, near)]
        found = statistics.median([*told, *[ROOM_HALF_M] * PRIOR_EDGES])
        known[where] = min(max(found, SHORTEST_SHARE * ROOM_HALF_M), LONGEST_SHARE * ROOM_HALF_M)
    return known[where]


def openness(graph: MapGraph, node_id: int | None = None) -> float:
    """How many times further views carry around a node than in a room, at least 1."""
    return max(1.0, half_m(graph, node_id) / ROOM_HALF_M)


def length_to_m(graph: MapGraph, node_id: int, inliers: int) -> float:
    """How far a picture is from a node with which it shares so many matches."""
    return match_length_m(inliers, keypoints_of(graph, node_id), half_m(graph, node_id))


def similarity_at(graph: MapGraph, node_id: int, length_m: float) -> float:
    """Matches that a picture taken so far from a node has with it."""
    return FULL_SHARE * keypoints_of(graph, node_id) / (1.0 + length_m / half_m(graph, node_id))


def edge_length_m(graph: MapGraph, edge: Edge) -> float:
    """Length of an edge: as driven, else by its matches."""
    if edge.length_m is not None:
        return edge.length_m
    return match_length_m(edge.inliers, _keypoints(graph, edge), half_m(graph, edge.a))


def _driven(graph: MapGraph, near: list[int] | None) -> list[Edge]:
    """Edges long enough to tell, that the robot drove and that may be used; between `near` nodes, or all."""
    edges = graph.edges.values() if near is None else graph.edges_among(near)
    return [edge for edge in edges if (edge.length_m or 0.0) >= SHORTEST_M and not edge.suspended]


def _told_by(graph: MapGraph, edge: Edge) -> float:
    assert edge.length_m is not None
    return half_told_m(edge.length_m, edge.inliers, _keypoints(graph, edge))


def keypoints_of(graph: MapGraph, node_id: int) -> int:
    """Keypoints of a node; of a picture that is none, as many as nodes have."""
    node = graph.nodes.get(node_id)
    return (node.keypoints if node is not None else 0) or graph.made_once(
        "keypoints", lambda: _typical(graph)
    )


def _typical(graph: MapGraph) -> int:
    counts = [node.keypoints for node in graph.nodes.values() if node.keypoints]
    return int(statistics.median(counts)) if counts else KEYPOINTS


def _keypoints(graph: MapGraph, edge: Edge) -> int:
    return min(keypoints_of(graph, edge.a), keypoints_of(graph, edge.b))
