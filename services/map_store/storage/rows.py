"""Graphs and histories as rows."""

from typing import Any

import msgpack
from pydantic import TypeAdapter
from sqlalchemy import Connection, Row, bindparam, delete, insert, select, update

from services.map_store.errors import CorruptError, GivenUpError
from services.map_store.integrity.seals import intact, matches, sealed
from services.map_store.storage.blobs import CHUNK, checksum
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import Change, Graph, Place, Step
from services.map_store.storage.tables import edges, nodes
from shared.messages.maps import Edge, Node

UPDATED = ("record", "revision", "seal")
"""What an update of a node writes; its features and thumbnail stay."""

STEPS: TypeAdapter[tuple[Step, ...]] = TypeAdapter(tuple[Step, ...])


def read_graph(connection: Connection, found: MapRecord) -> Graph:
    """Load one map; CorruptError names the row that is damaged, or says how many are missing."""
    stored = select(nodes).where(nodes.c.map_id == found.map_id).order_by(nodes.c.node_id)
    places = {row.node_id: parse_node(row) for row in connection.execute(stored).all()}
    links = connection.execute(
        select(edges).where(edges.c.map_id == found.map_id).order_by(edges.c.a, edges.c.b)
    ).all()
    graph = Graph(places, {(row.a, row.b): parse_edge(row) for row in links})
    missing = found.node_count - len(graph.places), found.edge_count - len(graph.edges)
    if missing != (0, 0):
        raise CorruptError(f"{missing[0]} nodes and {missing[1]} edges are missing")
    return graph


def parse_node(row: Row[Any]) -> Place:
    """A place from its row; CorruptError when the row does not match its seal."""
    if not intact(nodes, row):
        raise CorruptError(f"node {row.node_id}: its record does not match its checksum")
    node = Node.model_validate_json(row.record)
    return Place(node=node, features=row.features, thumbnail=row.thumbnail or "")


def parse_edge(row: Row[Any]) -> Edge:
    """An edge from its row; CorruptError when the row does not match its seal."""
    if not intact(edges, row):
        raise CorruptError(f"edge {row.a}-{row.b}: its record does not match its checksum")
    return Edge.model_validate_json(row.record)


def write_change(connection: Connection, map_id: int, revision: int, change: Change) -> None:
    """Write what changed; edges go first and come last because they refer to nodes."""
    places, links = change.graph.places, change.graph.edges
    touched = [n for n in sorted(change.rewritten | change.updated) if n in places]
    marked = _quarantined(connection, map_id, sorted(change.updated))
    _each(
        connection, delete(edges).where(*_edge_is(map_id)), [{"at_a": a, "at_b": b} for a, b in change.edges]
    )
    gone = [{"at": node_id} for node_id in change.rewritten]
    _each(connection, delete(nodes).where(nodes.c.map_id == map_id, nodes.c.node_id == bindparam("at")), gone)
    made = {n: node_row(map_id, revision, places[n], quarantined=n in marked) for n in touched}
    _each(connection, insert(nodes), [row for n, row in made.items() if n in change.rewritten])
    changed = [
        {"at": n, **{f"to_{name}": made[n][name] for name in UPDATED}} for n in touched if n in change.updated
    ]
    _each(
        connection,
        update(nodes)
        .where(nodes.c.map_id == map_id, nodes.c.node_id == bindparam("at"))
        .values({name: bindparam(f"to_{name}") for name in UPDATED}),
        changed,
    )
    present = [edge_row(map_id, revision, links[key]) for key in sorted(change.edges) if key in links]
    _each(connection, insert(edges), present)


def node_row(map_id: int, revision: int, place: Place, quarantined: bool = False) -> dict[str, Any]:
    """A place as its row."""
    values = {
        "map_id": map_id,
        "node_id": place.node.node_id,
        "revision": revision,
        "record": place.node.model_dump_json(),
        "features": place.features,
        "thumbnail": place.thumbnail or None,
        "quarantined": quarantined,
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


def read_history(content: bytes, sha256: str) -> dict[str, list[dict[str, Any]]]:
    """`steps` and `inverse` of one revision as stored; CorruptError when the checksum does not match."""
    if not matches(content, sha256):
        raise CorruptError("the stored operations do not match their checksum")
    fields: dict[str, list[dict[str, Any]]] = msgpack.unpackb(content)
    if not fields:
        raise GivenUpError("its operations were damaged; a repair gave them up")
    return fields


def pack_lost() -> tuple[bytes, str]:
    """What stands in the place of operations that are lost, with its checksum."""
    content = msgpack.packb({})
    return content, checksum(content)


def unpack_steps(content: bytes, sha256: str, inverse: bool) -> tuple[Step, ...]:
    """The steps of one revision, or those that lead back over it; CorruptError as for `read_history`."""
    return STEPS.validate_python(read_history(content, sha256)["inverse" if inverse else "steps"])


def _quarantined(connection: Connection, map_id: int, node_ids: list[int]) -> set[int]:
    """Which of these nodes are marked: an update of a record does not heal features."""
    query = select(nodes.c.node_id).where(nodes.c.map_id == map_id, nodes.c.quarantined)
    marked: set[int] = set()
    for start in range(0, len(node_ids), CHUNK):
        chunk = nodes.c.node_id.in_(node_ids[start : start + CHUNK])
        marked.update(connection.execute(query.where(chunk)).scalars())
    return marked


def _edge_is(map_id: int) -> tuple[Any, ...]:
    return edges.c.map_id == map_id, edges.c.a == bindparam("at_a"), edges.c.b == bindparam("at_b")


def _each(connection: Connection, statement: Any, values: list[dict[str, Any]]) -> None:
    if values:
        connection.execute(statement, values)
