"""Nodes whose features are damaged: marked, so that everyone sees it without reading the features."""

from sqlalchemy import ColumnElement, Connection, select, update

from services.map_store.integrity.seals import intact, sealed
from services.map_store.storage.tables import nodes


def mark(connection: Connection, chosen: ColumnElement[bool], quarantined: bool) -> None:
    """Put the chosen nodes in quarantine or take them out; a damaged row is not sealed as if it were good."""
    for row in connection.execute(select(nodes).where(chosen)).all():
        if row.quarantined == quarantined or not intact(nodes, row):
            continue
        values = sealed(nodes, {**row._mapping, "quarantined": quarantined})
        same = nodes.c.map_id == row.map_id, nodes.c.node_id == row.node_id
        connection.execute(update(nodes).where(*same).values(values))
