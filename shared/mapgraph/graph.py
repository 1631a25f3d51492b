"""A topological map in memory: nodes, edges and who is joined to whom. Pure."""

from collections.abc import Callable, Hashable, Iterable
from typing import TYPE_CHECKING, Any, TypeVar

from shared.mapgraph.operations import Draft
from shared.mapgraph.operations import EdgeKey as EdgeKey
from shared.mapgraph.triangle import Sight
from shared.messages.maps import AddNode, Edge, Node, Operation, UpdateNode
from shared.messages.places import Place, Route, Rule, Sign, key_of

if TYPE_CHECKING:
    from shared.mapgraph.links import Links

Made = TypeVar("Made")

MADE_MOST = 64
"""Things kept that were made of one state of the graph; chosen: the parts around 64 nodes, some 2 MB."""

UNDRIVEN_EDGES = 3.0
"""Chosen: how long an edge is that nobody drove is known to a factor of three (decision 0032)."""


def edge_key(first: int, second: int) -> EdgeKey:
    """The key of the edge between two nodes, in either order."""
    return (min(first, second), max(first, second))


class MapGraph:
    """Undirected graph of nodes (thesis section 4.2); once it was asked, only `apply` changes it.

    Attributes:
        places, rules, routes, signs: marks on the map, by the keys of their names.
    """

    def __init__(
        self,
        nodes: Iterable[Node] = (),
        edges: Iterable[Edge] = (),
        places: Iterable[Place] = (),
        rules: Iterable[Rule] = (),
        routes: Iterable[Route] = (),
        signs: Iterable[Sign] = (),
    ) -> None:
        self.nodes = {node.node_id: node for node in nodes}
        self.edges = {(edge.a, edge.b): edge for edge in edges}
        self.places = {key_of(place.name): place for place in places}
        self.rules = {key_of(rule.name): rule for rule in rules}
        self.routes = {key_of(route.name): route for route in routes}
        self.signs = {key_of(sign.name): sign for sign in signs}
        self._made: dict[Hashable, Any] = {}

    def apply(self, operations: Iterable[Operation]) -> None:
        """Change the graph as the map store does.

        Raises:
            GraphError: they do not fit; those before the one that does not are done.
        """
        draft = Draft(self.nodes, self.edges, self.places, self.rules, self.routes, self.signs)
        for operation in operations:
            match operation:
                case AddNode(node=node):
                    self._made.clear()
                    draft.add(node.node_id, node)
                case UpdateNode(node=node):  # changes nothing of who is joined to whom
                    draft.update(node.node_id, node)
                case _:
                    self._made.clear()
                    draft.apply(operation)

    def made_once(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What `make` makes of nodes' numbers, edges and marks; kept under `key` until they change."""
        found = self._made.get(key, self)
        if found is self:
            found = make()
            if len(self._made) >= MADE_MOST:
                self._made.clear()
            self._made[key] = found
        made: Made = found
        return made

    def next_id(self) -> int:
        """An id no node has had while the newest ones exist."""
        return max(self.nodes, default=-1) + 1

    def edge(self, first: int, second: int) -> Edge | None:
        """The edge between two nodes, in either order."""
        return self.edges.get(edge_key(first, second))

    def neighbours(self, node_id: int) -> list[int]:
        """Nodes an edge leads to, suspended ones excluded, in ascending order."""
        return self._links().neighbours(node_id)

    def heading(self, node_id: int, neighbour: int) -> float | None:
        """Bearing of a neighbour in the node's camera frame, radians; None when unknown."""
        edge = self.edge(node_id, neighbour)
        if edge is None:
            return None
        return edge.heading_ab_rad if edge.a == node_id else edge.heading_ba_rad

    def sight(self, node_id: int, neighbour: int) -> Sight | None:
        """A neighbour as seen from a node; None where no edge leads there or its yaw is unknown."""
        edge = self.edge(node_id, neighbour)
        if edge is None or edge.yaw_ab_rad is None:
            return None
        if edge.a == node_id:
            return Sight(edge.heading_ab_rad, edge.yaw_ab_rad)
        return Sight(edge.heading_ba_rad, -edge.yaw_ab_rad)

    def within(self, start: int, hops: int) -> set[int]:
        """Nodes at most so many edges from `start`, suspended ones excluded; `start` is one of them."""
        return self._links().within(start, hops)

    def edges_among(self, nodes: Iterable[int]) -> list[Edge]:
        """The edges that join two of these nodes, suspended ones excluded, by their numbers."""
        inside = set(nodes)
        pairs = sorted((a, b) for a in inside for b in self.neighbours(a) if a < b and b in inside)
        return [self.edges[pair] for pair in pairs]

    def within_cost(self, start: int, most: float, cost: Callable[[Edge], float | None]) -> set[int]:
        """Nodes to which a path costs at most so much; `start` is one of them.

        Args:
            start: the node to begin at.
            most: cost of a path.
            cost: of an edge; None where it may not be used.
        """
        return self._links().within_cost(start, most, lambda a, b: cost(self.edges[edge_key(a, b)]))

    def nearest(self, start: int, most: int) -> list[int]:
        """`start` and the nodes that edges join to it, nearest by number of edges first, at most so many."""
        links = self._links()
        order, known = [start], {start}
        for node in order:
            for neighbour in links.neighbours(node):
                if neighbour not in known and len(order) < most:
                    known.add(neighbour)
                    order.append(neighbour)
        return order

    def way(self, start: int, end: int) -> list[int]:
        """Nodes of a way over edges that may be used, rather driven ones than long jumps; [] if none leads.

        An edge that nobody drove counts as UNDRIVEN_EDGES driven ones.
        """
        return self._links().way(start, end, self._edges_apart)

    def _edges_apart(self, a: int, b: int) -> float:
        return 1.0 if self.edges[edge_key(a, b)].length_m is not None else UNDRIVEN_EDGES

    def components(self) -> int:
        """Number of connected parts, suspended edges excluded."""
        return self._links().components()

    def _links(self) -> "Links":
        """The edges that may be used."""
        return self.made_once("links", self._link)

    def _link(self) -> "Links":
        from shared.mapgraph.links import Links  # a fifth of the start of who keeps or shows maps only

        usable = (ends for ends, edge in self.edges.items() if not edge.suspended)
        return Links(self.nodes, usable)
