"""Nodes and edges as REST shows them, read straight from their rows."""

from typing import TypeVar

from pydantic import BaseModel, ValidationError
from sqlalchemy import select

from services.map_store import catalogue
from services.map_store.database import Database
from services.map_store.errors import CorruptError
from services.map_store.schemas import EdgeView, NodeView
from services.map_store.tables import edges, nodes
from shared.messages.maps import Edge, Node

P = TypeVar("P", bound=BaseModel)


def node_views(database: Database, name: str, after: int, limit: int) -> list[NodeView]:
    """Up to `limit` nodes with numbers above `after`."""
    with database.read() as connection:
        found = catalogue.find(connection, name)
        query = (
            select(nodes.c.record, nodes.c.revision, nodes.c.thumbnail, nodes.c.quarantined)
            .where(nodes.c.map_id == found.map_id, nodes.c.node_id > after)
            .order_by(nodes.c.node_id)
            .limit(limit)
        )
        rows = connection.execute(query).all()
    return [
        NodeView(
            **_parsed(Node, row.record).model_dump(),
            revision=row.revision,
            thumbnail=row.thumbnail is not None,
            quarantined=row.quarantined,
        )
        for row in rows
    ]


def edge_views(database: Database, name: str) -> list[EdgeView]:
    """All edges."""
    with database.read() as connection:
        found = catalogue.find(connection, name)
        query = (
            select(edges.c.record, edges.c.revision)
            .where(edges.c.map_id == found.map_id)
            .order_by(edges.c.a, edges.c.b)
        )
        rows = connection.execute(query).all()
    return [EdgeView(**_parsed(Edge, row.record).model_dump(), revision=row.revision) for row in rows]


def _parsed(kind: type[P], record: str) -> P:
    try:
        return kind.model_validate_json(record)
    except ValidationError as error:
        raise CorruptError(f"stored {kind.__name__.lower()}: {error.errors()[0]['msg']}") from error
