"""Graphs and histories as rows."""

from typing import Any

import msgpack
from pydantic import TypeAdapter
from sqlalchemy import Connection, bindparam, delete, insert, select, update

from services.map_store.blobs import checksum
from services.map_store.errors import CorruptError
from services.map_store.graph import Change, Graph, Place, Step
from services.map_store.tables import edges, nodes
from shared.messages.maps import Edge, Node

STEPS: TypeAdapter[tuple[Step, ...]] = TypeAdapter(tuple[Step, ...])


def read_graph(connection: Connection, map_id: int) -> Graph:
    """Load one map."""
    columns = (nodes.c.node_id, nodes.c.record, nodes.c.features, nodes.c.thumbnail)
    stored = connection.execute(select(*columns).where(nodes.c.map_id == map_id).order_by(nodes.c.node_id))
    places = {
        row.node_id: Place(
            node=Node.model_validate_json(row.record), features=row.features, thumbnail=row.thumbnail or ""
        )
        for row in stored
    }
    links = connection.execute(
        select(edges.c.a, edges.c.b, edges.c.record)
        .where(edges.c.map_id == map_id)
        .order_by(edges.c.a, edges.c.b)
    )
    return Graph(places, {(row.a, row.b): Edge.model_validate_json(row.record) for row in links})


def write_change(connection: Connection, map_id: int, revision: int, change: Change) -> None:
    """Write what changed; edges go first and come last because they refer to nodes."""
    _each(
        connection, delete(edges).where(*_edge_is(map_id)), [{"at_a": a, "at_b": b} for a, b in change.edges]
    )
    gone = [{"at": node_id} for node_id in change.rewritten]
    _each(connection, delete(nodes).where(nodes.c.map_id == map_id, nodes.c.node_id == bindparam("at")), gone)
    base = {"map_id": map_id, "revision": revision}
    places = change.graph.places
    added = [base | _node_row(places[n]) for n in sorted(change.rewritten) if n in places]
    _each(connection, insert(nodes), added)
    changed = [
        {"at": n, "to": places[n].node.model_dump_json(), "now": revision} for n in sorted(change.updated)
    ]
    _each(
        connection,
        update(nodes)
        .where(nodes.c.map_id == map_id, nodes.c.node_id == bindparam("at"))
        .values(record=bindparam("to"), revision=bindparam("now")),
        changed,
    )
    present = [change.graph.edges[key] for key in sorted(change.edges) if key in change.graph.edges]
    _each(
        connection,
        insert(edges),
        [base | {"a": edge.a, "b": edge.b, "record": edge.model_dump_json()} for edge in present],
    )


def pack_history(steps: tuple[Step, ...], inverse: tuple[Step, ...]) -> tuple[bytes, str]:
    """Steps and the way back as msgpack, with their checksum."""
    content = msgpack.packb({"steps": STEPS.dump_python(steps), "inverse": STEPS.dump_python(inverse)})
    return content, checksum(content)


def read_history(content: bytes, sha256: str) -> dict[str, list[dict[str, Any]]]:
    """`steps` and `inverse` of one revision as stored; CorruptError when the checksum does not match."""
    if checksum(content) != sha256:
        raise CorruptError("the stored operations do not match their checksum")
    fields: dict[str, list[dict[str, Any]]] = msgpack.unpackb(content)
    return fields


def unpack_inverse(content: bytes, sha256: str) -> tuple[Step, ...]:
    """The steps that lead back over one revision; CorruptError when the checksum does not match."""
    return STEPS.validate_python(read_history(content, sha256)["inverse"])


def _node_row(place: Place) -> dict[str, Any]:
    return {
        "node_id": place.node.node_id,
        "record": place.node.model_dump_json(),
        "features": place.features,
        "thumbnail": place.thumbnail or None,
        "quarantined": False,
    }


def _edge_is(map_id: int) -> tuple[Any, ...]:
    return edges.c.map_id == map_id, edges.c.a == bindparam("at_a"), edges.c.b == bindparam("at_b")


def _each(connection: Connection, statement: Any, values: list[dict[str, Any]]) -> None:
    if values:
        connection.execute(statement, values)
