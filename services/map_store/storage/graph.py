"""The map as a value: nodes, edges and marks, changed by steps that are checked and can be undone. Pure.

A step is an operation of the bus with the content of a new node replaced by the checksums of its blobs, so
that histories and undo need no pictures.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Literal

from pydantic import Field

from services.map_store.errors import ConflictError, InvalidError, MapError, MissingError
from shared.mapgraph.mark_draft import AnyMark, MarkWrite
from shared.mapgraph.marks import marks_of
from shared.mapgraph.operations import (
    Draft,
    EdgeKey,
    EdgeWrite,
    FullError,
    GraphError,
    InUseError,
    NodeWrite,
    TakenError,
)
from shared.messages.base import Part
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, MarkOperation, Node, PutEdge, UpdateNode
from shared.messages.places import (
    DeletePlace,
    DeleteRoute,
    DeleteRule,
    DeleteSign,
    Marks,
    Place,
    PutPlace,
    PutRoute,
    PutRule,
    PutSign,
    Route,
    Rule,
    Sign,
)

MAX_NODE_ID = 2**63 - 1
"""What a database integer holds."""

ERRORS: dict[type[GraphError], type[MapError]] = {
    TakenError: ConflictError,
    InUseError: ConflictError,
    FullError: InvalidError,
}
"""What the others mean here; an UnknownError is a MissingError."""


class StoredNode(Part):
    """A node with the checksums of its features and thumbnail ("" = none)."""

    node: Node
    features: str
    thumbnail: str = ""

    @property
    def node_id(self) -> int:
        """Its number."""
        return self.node.node_id

    @property
    def blobs(self) -> tuple[str, ...]:
        """Checksums of all blobs it needs."""
        return (self.features, self.thumbnail) if self.thumbnail else (self.features,)


class AddStoredNode(Part):
    """`AddNode` as the store keeps it; `place` is its name in every history that was ever written."""

    op: Literal["add_node"] = "add_node"
    place: StoredNode


Step = Annotated[
    AddStoredNode | UpdateNode | DeleteNode | PutEdge | DeleteEdge | MarkOperation, Field(discriminator="op")
]


def added_by(steps: Iterable[Step]) -> list[StoredNode]:
    """The nodes that these steps add."""
    return [step.place for step in steps if isinstance(step, AddStoredNode)]


@dataclass(frozen=True)
class Graph:
    """One revision of a map; its marks by the keys of their names."""

    nodes: Mapping[int, StoredNode] = field(default_factory=lambda: MappingProxyType({}))
    edges: Mapping[EdgeKey, Edge] = field(default_factory=lambda: MappingProxyType({}))
    places: Mapping[str, Place] = field(default_factory=lambda: MappingProxyType({}))
    rules: Mapping[str, Rule] = field(default_factory=lambda: MappingProxyType({}))
    routes: Mapping[str, Route] = field(default_factory=lambda: MappingProxyType({}))
    signs: Mapping[str, Sign] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def marks(self) -> Marks:
        """Places, rules, routes and signs."""
        return marks_of(self.places, self.rules, self.routes, self.signs)


@dataclass(frozen=True)
class Change:
    """What some steps did to a graph.

    Attributes:
        before, graph: the graph before and after them.
        inverse: steps that lead back.
        nodes, edges: those written or deleted on the way, the edges of deleted nodes included.
        marks: whether a mark was.
    """

    before: Graph
    graph: Graph
    inverse: tuple[Step, ...]
    nodes: frozenset[int]
    edges: frozenset[EdgeKey]
    marks: bool


def apply(graph: Graph, steps: Iterable[Step]) -> Change:
    """Apply all steps or none; `graph` itself never changes.

    Raises:
        MissingError, ConflictError, InvalidError: with the number of the step and the thing it names.
    """
    draft = Draft(
        dict(graph.nodes),
        dict(graph.edges),
        dict(graph.places),
        dict(graph.rules),
        dict(graph.routes),
        dict(graph.signs),
    )
    for number, step in enumerate(steps):
        try:
            _apply(draft, step)
        except GraphError as error:
            kind = ERRORS.get(type(error), MissingError)
            raise kind(f"operation {number} ({step.op}): {error}") from None
    return Change(
        before=graph,
        graph=Graph(
            MappingProxyType(draft.nodes),
            MappingProxyType(draft.edges),
            MappingProxyType(draft.marks.places),
            MappingProxyType(draft.marks.rules),
            MappingProxyType(draft.marks.routes),
            MappingProxyType(draft.marks.signs),
        ),
        inverse=tuple(_back(write) for write in reversed(draft.writes)),
        nodes=frozenset(write.node_id for write in draft.writes if isinstance(write, NodeWrite)),
        edges=frozenset(write.key for write in draft.writes if isinstance(write, EdgeWrite)),
        marks=any(isinstance(write, MarkWrite) for write in draft.writes),
    )


def _apply(draft: Draft[StoredNode], step: Step) -> None:
    match step:
        case AddStoredNode(place=added):
            if added.node_id > MAX_NODE_ID:
                raise FullError(f"node id must be at most {MAX_NODE_ID}, got {added.node_id}")
            draft.add(added.node_id, added)
        case UpdateNode(node=node):
            draft.update(node.node_id, draft.node(node.node_id).model_copy(update={"node": node}))
        case _:
            draft.apply(step)


def _back(write: NodeWrite[StoredNode] | EdgeWrite | MarkWrite) -> Step:
    """The step that takes a write back."""
    if isinstance(write, MarkWrite):
        return _mark_back(write)
    if isinstance(write, EdgeWrite):
        a, b = write.key
        return DeleteEdge(a=a, b=b) if write.before is None else PutEdge(edge=write.before)
    if write.before is None:
        return DeleteNode(node_id=write.node_id)
    if write.after is None:
        return AddStoredNode(place=write.before)
    return UpdateNode(node=write.before.node)


def _mark_back(write: MarkWrite) -> Step:
    if write.before is not None:
        return put(write.before)
    assert write.after is not None
    name = write.after.name
    match write.kind:
        case "place":
            return DeletePlace(name=name)
        case "route":
            return DeleteRoute(name=name)
        case "sign":
            return DeleteSign(name=name)
        case "rule":
            return DeleteRule(name=name)


def put(mark: AnyMark) -> PutPlace | PutRule | PutRoute | PutSign:
    """The step that writes a mark."""
    if isinstance(mark, Place):
        return PutPlace(place=mark)
    if isinstance(mark, Sign):
        return PutSign(sign=mark)
    return PutRoute(route=mark) if isinstance(mark, Route) else PutRule(rule=mark)
