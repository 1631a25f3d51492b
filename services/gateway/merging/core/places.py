"""A map as merging reads it: places, connections that may be used, and chains of them. Pure."""

import math
from collections import deque
from collections.abc import Iterable
from typing import NamedTuple

from shared.mapgraph.triangle import Sight
from shared.messages.maps import Edge, Node


class Chain(NamedTuple):
    """The way along connections from one place to another.

    Attributes:
        hops: connections on it.
        yaw_rad: rotation from the first place's camera to the last one's, the turns on the way added up.
    """

    hops: int
    yaw_rad: float


class Places:
    """The graph of one map; never changed.

    Only connections with a known turn count as neighbours, and none that experience speaks against.
    """

    def __init__(self, nodes: Iterable[Node], edges: Iterable[Edge]) -> None:
        self.nodes = {node.node_id: node for node in nodes}
        self.edges = tuple(edges)
        self._sights: dict[int, dict[int, Sight]] = {node_id: {} for node_id in self.nodes}
        for edge in self.edges:
            if edge.suspended or edge.yaw_ab_rad is None:
                continue
            self._sights[edge.a][edge.b] = Sight(edge.heading_ab_rad, edge.yaw_ab_rad)
            self._sights[edge.b][edge.a] = Sight(edge.heading_ba_rad, -edge.yaw_ab_rad)

    def neighbours(self, node_id: int) -> dict[int, Sight]:
        """The places connected with `node_id`, as they are seen from there."""
        return self._sights.get(node_id, {})

    def next_id(self) -> int:
        """An id above all that are taken."""
        return max(self.nodes, default=-1) + 1

    def pipelines(self) -> set[str]:
        """The pipelines that made the places."""
        return {node.pipeline for node in self.nodes.values()}

    def chains(self, start: int) -> dict[int, Chain]:
        """The shortest chain from `start` to every place that one leads to, by place; errors grow with it."""
        found = {start: Chain(0, 0.0)}
        waiting = deque([start])
        while waiting:
            place = waiting.popleft()
            for other, sight in self.neighbours(place).items():
                if other not in found and sight.yaw_rad is not None:
                    turned_rad = math.remainder(found[place].yaw_rad + sight.yaw_rad, math.tau)
                    found[other] = Chain(found[place].hops + 1, turned_rad)
                    waiting.append(other)
        return found
