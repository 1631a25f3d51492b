"""Tables of this version: made in an empty database, brought up to date in an older one, checked in any."""

from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel, ValidationError
from sqlalchemy import Column, Connection, Table, func, insert, inspect, select, text, update
from sqlalchemy.schema import CreateColumn

from services.map_store.errors import CorruptError, UnavailableError
from services.map_store.integrity import sqlite_file as integrity
from services.map_store.integrity.seals import digest, seal
from services.map_store.storage import tables
from services.map_store.storage.catalogue import write_marks
from shared.messages.maps import Edge, Node
from shared.messages.places import Marks

SEALED = (tables.maps, tables.revisions, tables.nodes, tables.edges, tables.missions)
RECORDS: dict[str, type[BaseModel]] = {"nodes": Node, "edges": Edge}


def refuse_later(connection: Connection) -> None:
    """Look before anything is written.

    Raises:
        UnavailableError: tables of a later version.
    """
    if inspect(connection).has_table(tables.about.name):
        versions = _versions(connection)
        if max(versions, default=0) > tables.VERSION:
            raise _of_another_version(versions)


def prepare(connection: Connection) -> None:
    """Make or migrate the tables, all in the caller's transaction."""
    tables.metadata.create_all(connection)
    versions = _versions(connection)
    if not versions:
        _write_about(connection)
    elif versions == [1]:
        _from_1(connection)
    elif versions in ([2], [3]):  # version 3 has one more table, made above
        _add_marks(connection)
        _write_about(connection)
    elif versions == [4]:  # version 5 has tables of tasks, schedules and inspections, made above
        _write_about(connection)


def require(connection: Connection) -> None:
    """Check that the tables are those of this version and described as they were made.

    Raises:
        UnavailableError: another version.
        CorruptError: their description in the file is damaged.
    """
    versions = _versions(connection)
    if versions != [tables.VERSION]:
        raise _of_another_version(versions)
    if connection.execute(select(tables.about.c.seal)).scalar_one() != _about_seal(connection):
        raise CorruptError("the description of the tables is damaged; restore a backup")


def _of_another_version(versions: Sequence[int]) -> UnavailableError:
    return UnavailableError(
        f"tables of version {tables.VERSION} expected, got {versions}; export the maps with the version "
        "that wrote them and import them here"
    )


def _versions(connection: Connection) -> Sequence[int]:
    return connection.execute(select(tables.about.c.version)).scalars().all()


def _from_1(connection: Connection) -> None:
    """Version 2 put a seal into every small row, and the number of nodes and edges beside each map."""
    _add_column(connection, tables.about, tables.about.c.seal)
    for column in (tables.maps.c.node_count, tables.maps.c.edge_count):
        _add_column(connection, tables.maps, column)
    for part, count in ((tables.nodes, "node_count"), (tables.edges, "edge_count")):
        number = select(func.count()).where(part.c.map_id == tables.maps.c.map_id).scalar_subquery()
        connection.execute(update(tables.maps).values({count: number}))
    for table in SEALED:
        _add_column(connection, table, table.c.seal)
        _seal_rows(connection, table)
    _add_marks(connection)
    _write_about(connection)


def _add_marks(connection: Connection) -> None:
    """Version 4 keeps places and rules, in a row of each map."""
    for map_id in connection.execute(select(tables.maps.c.map_id)).scalars().all():
        write_marks(connection, map_id, 0, Marks())


def _add_column(connection: Connection, table: Table, column: Column[Any]) -> None:
    definition = CreateColumn(column).compile(dialect=connection.dialect)
    connection.execute(text(f"ALTER TABLE {table.name} ADD COLUMN {definition}"))


def _seal_rows(connection: Connection, table: Table) -> None:
    """Seal what can be read; a record that cannot stays without a seal, and so counts as damaged."""
    kept = [column for column in table.columns if column.name != "content"]
    for row in connection.execute(select(*kept)).all():
        if not _readable(table, row._mapping.get("record")):
            continue
        same = (column == row._mapping[column.name] for column in table.primary_key)
        connection.execute(update(table).where(*same).values(seal=seal(table, row._mapping)))


def _readable(table: Table, record: str | None) -> bool:
    kind = RECORDS.get(table.name)
    try:
        return kind is None or kind.model_validate_json(record or "") is not None
    except ValidationError:
        return False


def _write_about(connection: Connection) -> None:
    connection.execute(tables.about.delete())
    connection.execute(insert(tables.about).values(version=tables.VERSION, seal=_about_seal(connection)))


def _about_seal(connection: Connection) -> str:
    described = integrity.description(connection) if connection.dialect.name == "sqlite" else []
    return digest([tables.VERSION, described])
