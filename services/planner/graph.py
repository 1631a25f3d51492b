"""The map in the planner's memory: places, edges and paths. Pure."""

import math
from collections.abc import Callable, Iterable, Mapping

import networkx as nx

from shared.mapgraph.edge_ends import edge_between as edge_between
from shared.messages.maps import AddNode, DeleteEdge, DeleteNode, Edge, Node, Operation, PutEdge, UpdateNode

EdgeCost = Callable[[Edge], float]

UNSEEN_GROUND = 6.0
"""Ground nobody has driven or seen free counts this much more: furniture may stand there."""

SUSPENDED_RAD = 20.0
"""Cost of an edge that experience speaks against: taken only where there is no other way."""


class MapGraph:
    """Undirected graph of places (thesis section 4.2); once it was asked, only `apply` changes it."""

    def __init__(self, nodes: Iterable[Node] = (), edges: Iterable[Edge] = ()) -> None:
        self.nodes = {node.node_id: node for node in nodes}
        self.edges = {(edge.a, edge.b): edge for edge in edges}
        self._linked: nx.Graph[int] | None = None

    def apply(self, operations: Iterable[Operation]) -> None:
        """Change the graph as the map store does."""
        self._linked = None
        for operation in operations:
            match operation:
                case AddNode() | UpdateNode():
                    self.nodes[operation.node.node_id] = operation.node
                case DeleteNode():
                    self.nodes.pop(operation.node_id, None)
                    self.edges = {ends: e for ends, e in self.edges.items() if operation.node_id not in ends}
                case PutEdge():
                    self.edges[operation.edge.a, operation.edge.b] = operation.edge
                case DeleteEdge():
                    self.edges.pop((operation.a, operation.b), None)

    def next_id(self) -> int:
        """An id no node has had while the newest ones exist."""
        return max(self.nodes, default=-1) + 1

    def edge(self, first: int, second: int) -> Edge | None:
        """The edge between two nodes, in either order."""
        return self.edges.get((min(first, second), max(first, second)))

    def neighbours(self, node_id: int) -> list[int]:
        """Nodes an edge leads to, suspended ones excluded, in ascending order."""
        links = self._links()
        return sorted(links[node_id]) if node_id in links else []

    def heading(self, node_id: int, neighbour: int) -> float | None:
        """Direction to a neighbour in the node's camera frame, radians; None when unknown."""
        edge = self.edge(node_id, neighbour)
        if edge is None:
            return None
        return edge.heading_ab_rad if edge.a == node_id else edge.heading_ba_rad

    def costs_to(self, targets: Mapping[int, float], cost: EdgeCost) -> dict[int, float]:
        """Cost from every node to the cheapest target; `targets` holds what each adds. Dijkstra.

        An edge of infinite cost is not used.
        """
        return dict(self._with_goal(targets, cost)[1])

    def path(self, source: int, targets: Mapping[int, float], cost: EdgeCost) -> list[int]:
        """Cheapest nodes from `source` to a target, both included; empty when there is none."""
        paths, _ = self._with_goal(targets, cost)
        return paths.get(source, [])

    def _with_goal(
        self, targets: Mapping[int, float], cost: EdgeCost
    ) -> tuple[dict[int, list[int]], dict[int, float]]:
        goal = -1  # no node has this id
        graph: nx.Graph[int] = nx.Graph()
        graph.add_nodes_from(sorted(self.nodes))
        for (a, b), edge in sorted(self.edges.items()):
            weight = cost(edge)
            if weight < math.inf:
                graph.add_edge(a, b, weight=weight)
        for node_id, extra in sorted(targets.items()):
            if node_id in self.nodes:
                graph.add_edge(node_id, goal, weight=extra)
        if goal not in graph:
            return {}, {}
        distances = nx.single_source_dijkstra_path_length(graph, goal)
        paths = nx.single_source_dijkstra_path(graph, goal)
        reached = [node for node in self.nodes if node in paths]
        return {n: list(reversed(paths[n][1:])) for n in reached}, {n: distances[n] for n in reached}

    def within(self, start: int, hops: int) -> set[int]:
        """Nodes at most so many edges from `start`, suspended ones excluded; `start` is one of them."""
        return set(nx.single_source_shortest_path_length(self._links(), start, cutoff=hops))

    def components(self) -> int:
        """Number of connected parts, suspended edges excluded."""
        return int(nx.number_connected_components(self._links()))

    def _links(self) -> "nx.Graph[int]":
        """The edges that may be used; built once between changes."""
        if self._linked is None:
            self._linked = nx.Graph()
            self._linked.add_nodes_from(self.nodes)
            self._linked.add_edges_from(ends for ends, edge in self.edges.items() if not edge.suspended)
        return self._linked


def fewest_nodes(edge: Edge) -> float:
    """The thesis's cost: every edge counts one (section 4.1)."""
    return SUSPENDED_RAD if edge.suspended else 1.0


def least_disparity(edge: Edge, least_rad: float = 0.0) -> float:
    """Sum of angular disparities, each at least `least_rad`; prefers edges driven or seen free."""
    disparity = max(least_rad, edge.disparity_rad if edge.disparity_rad is not None else 0.5)
    trust = 1.0 if edge.traversals or edge.clear else UNSEEN_GROUND
    return trust * disparity + 0.03 + 0.3 * edge.failures + SUSPENDED_RAD * edge.suspended
