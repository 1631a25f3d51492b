"""Which nodes a robot on its way between two others would be too near to. Pure.

A map has no positions. What lies beside a leg is told by the ways between nodes: a wall between two rooms
makes them long, and robots on both sides of it do not meet.
"""

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import networkx as nx

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import edge_length_m
from shared.mapgraph.routing import way_m

NEAR_M = 1.05
"""Two robots, with their middles so near, are too near; chosen: twice their radius of 0.25 m, and for each
what it drives beside its leg and lengths of ways are off by."""

BODIES_MAX = 4096
"""Ways of robots that are kept; chosen: those of a minute."""

Leg = tuple[int, int]


class Body(NamedTuple):
    """What a robot takes up.

    Attributes:
        nodes: between which it is or may drive.
        zone: nodes at which nobody else may be meanwhile.
    """

    nodes: frozenset[int]
    zone: frozenset[int]


class Nearness:
    """Of one map as it is; what was asked once is kept."""

    def __init__(self, graph: MapGraph) -> None:
        self.graph: nx.Graph[int] = nx.Graph()
        self.graph.add_nodes_from(graph.nodes)
        for (a, b), edge in graph.edges.items():
            if not edge.suspended:
                length_m = edge_length_m(graph, edge)
                self.graph.add_edge(a, b, weight=length_m, cost_m=way_m(graph, edge))
        self._zones: dict[Leg, frozenset[int]] = {}
        self._bodies: dict[tuple[int, ...], Body] = {}
        self._lengths: dict[tuple[int, int], dict[int, float]] = {}

    def zone(self, leg: Leg) -> frozenset[int]:
        """Nodes less than NEAR_M beside a leg, its ends among them; of a spot the leg has one end twice."""
        if leg not in self._zones:
            self._zones[leg] = self._zones[leg[::-1]] = self._beside(*leg)
        return self._zones[leg]

    def body(self, way: tuple[int, ...]) -> Body:
        """Of a robot that is, or may drive, along a way: its nodes in order."""
        if way not in self._bodies:
            if len(self._bodies) >= BODIES_MAX:
                self._bodies.clear()
            legs = [*pairwise(way), *((node, node) for node in way[:1])]
            zone = frozenset[int]().union(*(self.zone(leg) for leg in legs))
            self._bodies[way] = Body(frozenset(way), zone)
        return self._bodies[way]

    def apart_m(self, some: Iterable[int], others: Iterable[int]) -> float:
        """Length of the shortest way between two groups of nodes, infinite beyond a few metres."""
        wanted = set(others)
        return min(
            (
                length_m
                for node in some
                for other, length_m in self.lengths_m(node, 4).items()
                if other in wanted
            ),
            default=math.inf,
        )

    def lengths_m(self, node: int, most_m: int) -> dict[int, float]:
        """Of the ways from a node to those at most so far."""
        if node not in self.graph:
            return {node: 0.0}
        if (node, most_m) not in self._lengths:
            found: dict[int, float] = nx.single_source_dijkstra_path_length(self.graph, node, most_m)
            self._lengths[node, most_m] = found
        return self._lengths[node, most_m]

    def _beside(self, a: int, b: int) -> frozenset[int]:
        long_m = self.graph.edges[a, b]["weight"] if self.graph.has_edge(a, b) else 0.0
        most_m = math.ceil(long_m + NEAR_M)
        from_a, from_b = self.lengths_m(a, most_m), self.lengths_m(b, most_m)
        near = (n for n in from_a if n in from_b and _to_leg_m(from_a[n], from_b[n], long_m) < NEAR_M)
        return frozenset((a, b, *near))


def _to_leg_m(to_a_m: float, to_b_m: float, long_m: float) -> float:
    """How far a point is from a leg, by its distances from the ends."""
    if long_m <= 0.0:
        return min(to_a_m, to_b_m)
    along_m = (to_a_m**2 + long_m**2 - to_b_m**2) / (2.0 * long_m)
    if not 0.0 < along_m < long_m:
        return min(to_a_m, to_b_m)
    return math.sqrt(max(0.0, to_a_m**2 - along_m**2))
