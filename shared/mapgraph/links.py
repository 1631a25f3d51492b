"""Who is joined to whom in a map, and by which way. Pure; apart from MapGraph, for it loads networkx."""

from collections.abc import Callable, Iterable

import networkx as nx

from shared.mapgraph.operations import EdgeKey

Weight = Callable[[int, int], float | None]
"""What it costs to go from one node to another that an edge joins to it; None where one may not."""


class Links:
    """Nodes and the edges that may be used."""

    def __init__(self, nodes: Iterable[int], edges: Iterable[EdgeKey]) -> None:
        self._graph: nx.Graph[int] = nx.Graph()
        self._graph.add_nodes_from(nodes)
        self._graph.add_edges_from(edges)

    def neighbours(self, node: int) -> list[int]:
        """Nodes that an edge joins to this one, ascending; none of a node that is not there."""
        return sorted(self._graph[node]) if node in self._graph else []

    def within(self, start: int, hops: int) -> set[int]:
        """Nodes at most so many edges from `start`; `start` is one of them."""
        return set(nx.single_source_shortest_path_length(self._graph, start, cutoff=hops))

    def within_cost(self, start: int, most: float, weight: Weight) -> set[int]:
        """Nodes to which a way costs at most so much; `start` is one of them."""
        found = nx.single_source_dijkstra_path_length(
            self._graph, start, cutoff=most, weight=lambda a, b, _: weight(a, b)
        )
        return set(found)

    def way(self, start: int, end: int, weight: Weight) -> list[int]:
        """Nodes of the cheapest way (Dijkstra), both ends among them; [] if none leads."""
        try:
            found = nx.dijkstra_path(self._graph, start, end, lambda a, b, _: weight(a, b))
        except (nx.NodeNotFound, nx.NetworkXNoPath):
            return []
        return [int(node) for node in found]

    def components(self) -> int:
        """Number of connected parts."""
        return int(nx.number_connected_components(self._graph))
