"""What the operations of a transaction do to a graph: checked, carried out, and with the way back. Pure.

The map store keeps checksums with each node, a planner only its record: `N` is what either calls a node.
"""

from typing import Generic, NamedTuple, TypeVar

from shared.mapgraph.mark_draft import FullError as FullError
from shared.mapgraph.mark_draft import GraphError as GraphError
from shared.mapgraph.mark_draft import InUseError as InUseError
from shared.mapgraph.mark_draft import MarkDraft, MarkWrite
from shared.mapgraph.mark_draft import TakenError as TakenError
from shared.mapgraph.mark_draft import UnknownError as UnknownError
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, MarkOperation, PutEdge
from shared.messages.places import Place, Route, Rule, Sign
from shared.wire import MAX_CONTAINER

N = TypeVar("N")

EdgeKey = tuple[int, int]
"""The two nodes of an edge, a < b."""


class NodeWrite(NamedTuple, Generic[N]):
    """A node before and after; None where there is none."""

    node_id: int
    before: N | None
    after: N | None


class EdgeWrite(NamedTuple):
    """An edge before and after; None where there is none."""

    key: EdgeKey
    before: Edge | None
    after: Edge | None


class Draft(Generic[N]):
    """A graph being changed in place.

    Attributes:
        nodes, edges: as they are by now, by number and by pair of numbers.
        marks: places, rules, routes and signs likewise, by the keys of their names.
        writes: what was done; backwards, with before and after exchanged, it leads back.
    """

    def __init__(
        self,
        nodes: dict[int, N],
        edges: dict[EdgeKey, Edge],
        places: dict[str, Place] | None = None,
        rules: dict[str, Rule] | None = None,
        routes: dict[str, Route] | None = None,
        signs: dict[str, Sign] | None = None,
    ) -> None:
        self.nodes, self.edges = nodes, edges
        self.writes: list[NodeWrite[N] | EdgeWrite | MarkWrite] = []
        self.marks = MarkDraft(
            {} if places is None else places,
            {} if rules is None else rules,
            {} if routes is None else routes,
            {} if signs is None else signs,
            nodes,
            self.writes.append,
        )
        self._neighbours: dict[int, set[int]] | None = None

    def add(self, node_id: int, node: N) -> None:
        """Add a node. Raises TakenError, FullError."""
        if node_id in self.nodes:
            raise TakenError(f"node {node_id} exists already")
        if len(self.nodes) >= MAX_CONTAINER:
            raise FullError(f"a map holds at most {MAX_CONTAINER} nodes; start another map")
        self._write_node(node_id, node)

    def update(self, node_id: int, node: N) -> None:
        """Put another node in the place of one, its edges stay. Raises UnknownError."""
        self.node(node_id)
        self._write_node(node_id, node)

    def node(self, node_id: int) -> N:
        """One node. Raises UnknownError."""
        if node_id not in self.nodes:
            raise UnknownError(f"node {node_id} does not exist")
        return self.nodes[node_id]

    def apply(self, operation: DeleteNode | PutEdge | DeleteEdge | MarkOperation) -> None:
        """Do what is the same whatever a node is. Raises UnknownError, InUseError, FullError."""
        match operation:
            case DeleteNode(node_id=node_id):
                self._delete(node_id)
            case PutEdge(edge=edge):
                self._put_edge(edge)
            case DeleteEdge(a=a, b=b):
                self._delete_edge((a, b))
            case _:
                self.marks.apply(operation)

    def _delete(self, node_id: int) -> None:
        """Marks go first: on the way back the node and its edges are there again before them."""
        self.node(node_id)
        self.marks.forget_node(node_id)
        for other in sorted(self._adjacency().get(node_id, ())):
            self._delete_edge((min(node_id, other), max(node_id, other)))
        self._write_node(node_id, None)

    def _put_edge(self, edge: Edge) -> None:
        key = (edge.a, edge.b)
        for end in key:
            self.node(end)
        if key not in self.edges and len(self.edges) >= MAX_CONTAINER:
            raise FullError(f"a map holds at most {MAX_CONTAINER} edges; start another map")
        self._write_edge(key, edge)

    def _delete_edge(self, key: EdgeKey) -> None:
        if key not in self.edges:
            raise UnknownError(f"edge {key[0]}-{key[1]} does not exist")
        self._write_edge(key, None)

    def _write_node(self, node_id: int, after: N | None) -> None:
        self.writes.append(NodeWrite(node_id, self.nodes.get(node_id), after))
        if after is not None:
            self.nodes[node_id] = after
        else:
            del self.nodes[node_id]

    def _write_edge(self, key: EdgeKey, after: Edge | None) -> None:
        self.writes.append(EdgeWrite(key, self.edges.get(key), after))
        if after is not None:
            self.edges[key] = after
        else:
            del self.edges[key]
        if self._neighbours is not None:
            _join(self._neighbours, key, joined=after is not None)

    def _adjacency(self) -> dict[int, set[int]]:
        """Who is joined to whom; built when the first node is deleted, kept up to date from then on."""
        if self._neighbours is None:
            self._neighbours = {}
            for key in self.edges:
                _join(self._neighbours, key, joined=True)
        return self._neighbours


def _join(neighbours: dict[int, set[int]], key: EdgeKey, joined: bool) -> None:
    for one, other in (key, key[::-1]):
        if joined:
            neighbours.setdefault(one, set()).add(other)
        else:
            neighbours[one].discard(other)
