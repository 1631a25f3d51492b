"""Nodes and edges as REST shows them, read straight from their rows."""

from sqlalchemy import select

from services.map_store.api.schemas import EdgeView, NodeView
from services.map_store.errors import CorruptError
from services.map_store.storage import catalogue
from services.map_store.storage.rows import parse_edge, parse_node
from services.map_store.storage.tables import edges, nodes
from services.map_store.store import MapStore


def node_views(store: MapStore, name: str, after: int, limit: int) -> list[NodeView]:
    """Up to `limit` nodes with numbers above `after`."""
    store.graph(name)  # a map with a row missing is refused, not shown without it
    with store.database.read() as connection:
        found = catalogue.find(connection, name)
        query = (
            select(nodes)
            .where(nodes.c.map_id == found.map_id, nodes.c.node_id > after)
            .order_by(nodes.c.node_id)
            .limit(limit)
        )
        rows = connection.execute(query).all()
        damaged = store.contents.damaged(connection, (row.features for row in rows))
    try:
        return [
            NodeView(
                **parse_node(row).node.model_dump(),
                revision=row.revision,
                thumbnail=row.thumbnail is not None,
                quarantined=row.features in damaged,
            )
            for row in rows
        ]
    except CorruptError as error:
        raise CorruptError(f"map {name!r}: {error}; 'topnav map repair {name}' mends it") from None


def edge_views(store: MapStore, name: str) -> list[EdgeView]:
    """All edges."""
    store.graph(name)
    with store.database.read() as connection:
        found = catalogue.find(connection, name)
        query = select(edges).where(edges.c.map_id == found.map_id).order_by(edges.c.a, edges.c.b)
        rows = connection.execute(query).all()
    try:
        return [EdgeView(**parse_edge(row).model_dump(), revision=row.revision) for row in rows]
    except CorruptError as error:
        raise CorruptError(f"map {name!r}: {error}; 'topnav map repair {name}' mends it") from None
