"""The map as a value: places and edges, changed by steps that are checked and can be undone. Pure.

A step is an operation of the bus with the content of a new place replaced by the checksums of its blobs, so
that histories and undo need no pictures.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Literal

from pydantic import Field

from services.map_store.errors import ConflictError, InvalidError, MapError, MissingError
from shared.messages.base import Part
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, Node, PutEdge, UpdateNode
from shared.wire import MAX_CONTAINER

Key = tuple[int, int]
"""The two nodes of an edge, a < b."""

MAX_NODE_ID = 2**63 - 1
"""What a database integer holds."""


class Place(Part):
    """A node with the checksums of its features and thumbnail ("" = none)."""

    node: Node
    features: str
    thumbnail: str = ""


class AddPlace(Part):
    """`AddNode` as the store keeps it."""

    op: Literal["add_node"] = "add_node"
    place: Place


Step = Annotated[AddPlace | UpdateNode | DeleteNode | PutEdge | DeleteEdge, Field(discriminator="op")]


@dataclass(frozen=True)
class Graph:
    """One revision of a map."""

    places: Mapping[int, Place] = field(default_factory=lambda: MappingProxyType({}))
    edges: Mapping[Key, Edge] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True)
class Change:
    """What some steps did to a graph.

    Attributes:
        graph: the graph after them.
        inverse: steps that lead back.
        rewritten: nodes added or deleted on the way; their rows are written anew.
        updated: nodes that only changed.
        edges: edges put or deleted on the way, those of deleted nodes included.
    """

    graph: Graph
    inverse: tuple[Step, ...]
    rewritten: frozenset[int]
    updated: frozenset[int]
    edges: frozenset[Key]


def apply(graph: Graph, steps: Iterable[Step]) -> Change:
    """Apply all steps or none; `graph` itself never changes.

    Raises:
        MissingError, ConflictError, InvalidError: with the number of the step and the thing it names.
    """
    draft = _Draft(graph)
    for number, step in enumerate(steps):
        try:
            draft.apply(step)
        except MapError as error:
            raise type(error)(f"operation {number} ({step.op}): {error}") from None
    return draft.finish()


class _Draft:
    """A graph being changed, with the way back."""

    def __init__(self, graph: Graph) -> None:
        self._places, self._edges = dict(graph.places), dict(graph.edges)
        self._neighbours: dict[int, set[int]] | None = None
        self._inverse: list[Step] = []
        self._rewritten: set[int] = set()
        self._updated: set[int] = set()
        self._touched: set[Key] = set()

    def apply(self, step: Step) -> None:
        match step:
            case AddPlace(place=place):
                self._add(place)
            case UpdateNode(node=node):
                self._update(node)
            case DeleteNode(node_id=node_id):
                self._delete(node_id)
            case PutEdge(edge=edge):
                self._put_edge(edge)
            case DeleteEdge(a=a, b=b):
                self._delete_edge((a, b))

    def finish(self) -> Change:
        graph = Graph(MappingProxyType(self._places), MappingProxyType(self._edges))
        return Change(
            graph=graph,
            inverse=tuple(reversed(self._inverse)),
            rewritten=frozenset(self._rewritten),
            updated=frozenset(self._updated - self._rewritten),
            edges=frozenset(self._touched),
        )

    def _add(self, place: Place) -> None:
        node_id = place.node.node_id
        if node_id in self._places:
            raise ConflictError(f"node {node_id} exists already")
        if node_id > MAX_NODE_ID:
            raise InvalidError(f"node id must be at most {MAX_NODE_ID}, got {node_id}")
        if len(self._places) >= MAX_CONTAINER:
            raise InvalidError(f"a map holds at most {MAX_CONTAINER} nodes; start another map")
        self._places[node_id] = place
        self._rewritten.add(node_id)
        self._inverse.append(DeleteNode(node_id=node_id))

    def _update(self, node: Node) -> None:
        before = self._place(node.node_id)
        self._places[node.node_id] = before.model_copy(update={"node": node})
        self._updated.add(node.node_id)
        self._inverse.append(UpdateNode(node=before.node))

    def _delete(self, node_id: int) -> None:
        before = self._place(node_id)
        for other in sorted(self._adjacency().get(node_id, ())):
            self._delete_edge((min(node_id, other), max(node_id, other)))
        del self._places[node_id]
        self._rewritten.add(node_id)
        self._inverse.append(AddPlace(place=before))

    def _put_edge(self, edge: Edge) -> None:
        key = (edge.a, edge.b)
        for end in key:
            self._place(end)
        before = self._edges.get(key)
        if before is None and len(self._edges) >= MAX_CONTAINER:
            raise InvalidError(f"a map holds at most {MAX_CONTAINER} edges; start another map")
        self._edges[key] = edge
        self._touched.add(key)
        self._link(key)
        self._inverse.append(DeleteEdge(a=edge.a, b=edge.b) if before is None else PutEdge(edge=before))

    def _delete_edge(self, key: Key) -> None:
        before = self._edges.pop(key, None)
        if before is None:
            raise MissingError(f"edge {key[0]}-{key[1]} does not exist")
        self._touched.add(key)
        if self._neighbours is not None:
            self._neighbours[key[0]].discard(key[1])
            self._neighbours[key[1]].discard(key[0])
        self._inverse.append(PutEdge(edge=before))

    def _place(self, node_id: int) -> Place:
        place = self._places.get(node_id)
        if place is None:
            raise MissingError(f"node {node_id} does not exist")
        return place

    def _adjacency(self) -> dict[int, set[int]]:
        """Who is joined to whom; built when the first node is deleted, kept up to date from then on."""
        if self._neighbours is None:
            self._neighbours = {}
            for key in self._edges:
                self._link(key)
        return self._neighbours

    def _link(self, key: Key) -> None:
        if self._neighbours is not None:
            self._neighbours.setdefault(key[0], set()).add(key[1])
            self._neighbours.setdefault(key[1], set()).add(key[0])
