"""Maps made by hand: a corridor of nodes a metre apart, with rooms beside it."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

from services.fleet.traffic.nearness import Nearness
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node


def corridor(length: int, rooms: Mapping[int, Sequence[int]] | None = None) -> Nearness:
    """Nodes 0, 1, ... along a corridor; each room is a chain of nodes that begins beside one of them."""
    legs = [*pairwise(range(length))]
    for door, chain in (rooms or {}).items():
        legs += pairwise((door, *chain))
    edges = [Edge(a=min(leg), b=max(leg), length_m=1.0, traversals=1) for leg in legs]
    nodes = sorted({*range(length), *(node for leg in legs for node in leg)})
    return Nearness(MapGraph([Node(node_id=node) for node in nodes], edges))
