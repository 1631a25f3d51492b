"""Graphs and histories as rows."""

from typing import Any

import msgpack
from pydantic import TypeAdapter
from sqlalchemy import Connection, Row, bindparam, delete, insert, select, update

from services.map_store.errors import CorruptError, GivenUpError
from services.map_store.integrity.seals import intact, matches, sealed
from services.map_store.storage.blobs import checksum
from services.map_store.storage.catalogue import MapRecord, parse_marks, write_marks
from services.map_store.storage.graph import Change, Graph, Step, StoredNode
from services.map_store.storage.tables import edges, marks, nodes
from shared.mapgraph.marks import by_key
from shared.messages.maps import Edge, Node

THIS_EDGE = edges.c.map_id == bindparam("of"), edges.c.a == bindparam("at_a"), edges.c.b == bindparam("at_b")
THIS_NODE = nodes.c.map_id == bindparam("of"), nodes.c.node_id == bindparam("at")
DELETE_EDGE, DELETE_NODE = delete(edges).where(*THIS_EDGE), delete(nodes).where(*THIS_NODE)
UPDATE_NODE, INSERT_NODE, INSERT_EDGE = update(nodes).where(*THIS_NODE), insert(nodes), insert(edges)

STEPS: TypeAdapter[tuple[Step, ...]] = TypeAdapter(tuple[Step, ...])


def read_graph(connection: Connection, found: MapRecord) -> Graph:
    """Load one map; CorruptError names the row that is damaged, or says how many are missing."""
    stored = select(nodes).where(nodes.c.map_id == found.map_id).order_by(nodes.c.node_id)
    joined = select(edges).where(edges.c.map_id == found.map_id).order_by(edges.c.a, edges.c.b)
    written = parse_marks(connection.execute(select(marks).where(marks.c.map_id == found.map_id)).first())
    graph = Graph(
        {row.node_id: parse_node(row) for row in connection.execute(stored).all()},
        {(row.a, row.b): parse_edge(row) for row in connection.execute(joined).all()},
        by_key(written.places),
        by_key(written.rules),
        by_key(written.routes),
        by_key(written.signs),
    )
    missing = found.node_count - len(graph.nodes), found.edge_count - len(graph.edges)
    if missing != (0, 0):
        raise CorruptError(f"{missing[0]} nodes and {missing[1]} edges are missing")
    return graph


def parse_node(row: Row[Any]) -> StoredNode:
    """A node from its row; CorruptError when the row does not match its seal."""
    if not intact(nodes, row):
        raise CorruptError(f"node {row.node_id}: its record does not match its checksum")
    node = Node.model_validate_json(row.record)
    return StoredNode(node=node, features=row.features, thumbnail=row.thumbnail or "")


def parse_edge(row: Row[Any]) -> Edge:
    """An edge from its row; CorruptError when the row does not match its seal."""
    if not intact(edges, row):
        raise CorruptError(f"edge {row.a}-{row.b}: its record does not match its checksum")
    return Edge.model_validate_json(row.record)


def write_change(connection: Connection, map_id: int, revision: int, change: Change) -> None:
    """Write what changed; edges go first and come last because they refer to nodes."""
    nodes_now, edges_now = change.graph.nodes, change.graph.edges
    known, joined = change.before.nodes, change.edges & change.before.edges.keys()
    _each(connection, DELETE_EDGE, [{"of": map_id, "at_a": a, "at_b": b} for a, b in joined])
    gone = change.nodes - nodes_now.keys()
    _each(connection, DELETE_NODE, [{"of": map_id, "at": n} for n in gone])
    made = {n: node_row(map_id, revision, nodes_now[n]) for n in sorted(change.nodes & nodes_now.keys())}
    _each(connection, INSERT_NODE, [row for n, row in made.items() if n not in known])
    replaced = [{"of": map_id, "at": n, **_without_key(row)} for n, row in made.items() if n in known]
    _each(connection, UPDATE_NODE, replaced)
    put = [edge_row(map_id, revision, edges_now[k]) for k in sorted(change.edges & edges_now.keys())]
    _each(connection, INSERT_EDGE, put)
    if change.marks:
        write_marks(connection, map_id, revision, change.graph.marks)


def node_row(map_id: int, revision: int, stored: StoredNode) -> dict[str, Any]:
    """A node as its row."""
    values = {
        "map_id": map_id,
        "node_id": stored.node_id,
        "revision": revision,
        "record": stored.node.model_dump_json(),
        "features": stored.features,
        "thumbnail": stored.thumbnail or None,
        "quarantined": False,
    }
    return sealed(nodes, values)


def edge_row(map_id: int, revision: int, edge: Edge) -> dict[str, Any]:
    """An edge as its row."""
    record = edge.model_dump_json()
    values = {"map_id": map_id, "a": edge.a, "b": edge.b, "revision": revision, "record": record}
    return sealed(edges, values)


def pack_history(steps: tuple[Step, ...], inverse: tuple[Step, ...]) -> tuple[bytes, str]:
    """Steps and the way back as msgpack, with their checksum."""
    content = msgpack.packb({"steps": STEPS.dump_python(steps), "inverse": STEPS.dump_python(inverse)})
    return content, checksum(content)


def pack_lost() -> tuple[bytes, str]:
    """What stands in the place of operations that are lost, with its checksum."""
    content = msgpack.packb({})
    return content, checksum(content)


def read_history(content: bytes, sha256: str) -> dict[str, list[dict[str, Any]]]:
    """`steps` and `inverse` of one revision as stored; CorruptError when the checksum does not match."""
    if not matches(content, sha256):
        raise CorruptError("the stored operations do not match their checksum")
    fields: dict[str, list[dict[str, Any]]] = msgpack.unpackb(content)
    if not fields:
        raise GivenUpError("its operations were damaged; a repair gave them up")
    return fields


def unpack_steps(content: bytes, sha256: str, inverse: bool) -> tuple[Step, ...]:
    """The steps of one revision, or those that lead back over it; CorruptError as for `read_history`."""
    return STEPS.validate_python(read_history(content, sha256)["inverse" if inverse else "steps"])


def _without_key(row: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in row.items() if name not in ("map_id", "node_id")}


def _each(connection: Connection, statement: Any, values: list[dict[str, Any]]) -> None:
    if values:
        connection.execute(statement, values)
