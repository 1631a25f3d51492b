"""A map as merging reads it: every edge that may be used as seen from both ends, and chains of them. Pure."""

import math
from collections import deque
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.triangle import Sight
from shared.messages.maps import Edge, Node


class Chain(NamedTuple):
    """The way along edges from one node to another.

    Attributes:
        hops: edges on it.
        yaw_rad: rotation from the first node's camera to the last one's, the yaws on the way added up.
    """

    hops: int
    yaw_rad: float


class SightGraph(MapGraph):
    """The graph of one map, never changed.

    Attributes:
        sights: by node its neighbours as seen from there; only along edges of known yaw, none suspended.
    """

    def __init__(self, nodes: Iterable[Node] = (), edges: Iterable[Edge] = ()) -> None:
        super().__init__(nodes, edges)
        self.sights: Mapping[int, Mapping[int, Sight]] = {
            node_id: {n: sight for n in self.neighbours(node_id) if (sight := self.sight(node_id, n))}
            for node_id in self.nodes
        }

    def chains(self, start: int) -> dict[int, Chain]:
        """The shortest chain from `start` to every node that one leads to, by node; errors grow with it."""
        found = {start: Chain(0, 0.0)}
        waiting = deque([start])
        while waiting:
            node_id = waiting.popleft()
            for other, sight in self.sights[node_id].items():
                if other not in found and sight.yaw_rad is not None:
                    yaw_rad = math.remainder(found[node_id].yaw_rad + sight.yaw_rad, math.tau)
                    found[other] = Chain(found[node_id].hops + 1, yaw_rad)
                    waiting.append(other)
        return found
