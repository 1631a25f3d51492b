"""Maps by name: find, list, create, rename, delete; their marks. All inside the caller's transaction."""

import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from sqlalchemy import Connection, Row, bindparam, delete, insert, select, update

from services.map_store.errors import ConflictError, CorruptError, InvalidError, MissingError
from services.map_store.integrity.seals import intact, sealed
from services.map_store.storage import blobs
from services.map_store.storage.tables import edges, inspections, maps, marks, nodes, revisions
from shared.messages.places import Marks
from shared.transport.keys import NAME

NEW_NAME = re.compile(r"(?!import\Z)[a-z0-9_][a-z0-9_-]{0,63}\Z")
"""Commands take "--help" for an option; /maps/import is a path of REST. Maps of old may have such names."""

ALL = select(maps).order_by(maps.c.map_id)
BY_NAME = select(maps).where(maps.c.name == bindparam("name"))
OF_MAP = update(maps).where(maps.c.map_id == bindparam("of"))
"""Made once: to compose a statement takes SQLAlchemy several times as long as to execute it."""

LISTED = 20
"""Names in an error: with their longest it still fits the 1000 characters of a problem's detail."""


@dataclass(frozen=True)
class MapRecord:
    """One line of the list of maps; times are nanoseconds since the Unix epoch."""

    map_id: int
    name: str
    revision: int
    created_ns: int
    changed_ns: int
    node_count: int = 0
    edge_count: int = 0


def check_name(name: str) -> str:
    """Return `name`, or raise InvalidError: the rule of the bus holds everywhere."""
    if not NAME.match(name):
        raise InvalidError(f"map name must match [a-z0-9_-]{{1,64}}, got {name[:80]!r}")
    return name


def check_new_name(name: str) -> str:
    """Return `name`, or raise InvalidError: a map's new name cannot be mistaken for something else."""
    if not NEW_NAME.match(check_name(name)):
        raise InvalidError(
            f"a map's new name must not begin with '-' nor be 'import', got {name!r}: commands and paths "
            "would take it for something else; choose another, for an archive with --name (?name= over HTTP)"
        )
    return name


def label(row: Row[Any]) -> str:
    """What a map is called, even where damage made its name one that nobody can ask for."""
    good = isinstance(row.name, str) and NAME.match(row.name) is not None
    return str(row.name) if good else f"damaged-{row.map_id}"


def rows(connection: Connection) -> Sequence[Row[Any]]:
    """The records of all maps by number; no index that may be damaged is asked."""
    return connection.execute(ALL).all()


def find(connection: Connection, name: str) -> MapRecord:
    """The record of a map; MissingError lists what there is, CorruptError says that it is damaged."""
    check_name(name)
    row = connection.execute(BY_NAME, {"name": name}).first()
    if row is not None and row.name == name and intact(maps, row):
        return record_of(row)
    found = rows(connection)  # the index of names may be damaged
    for row in found:
        if label(row) == name:
            return record_of(row)
    damaged = sum(not intact(maps, row) for row in found)
    if damaged:
        raise CorruptError(f"no map {name!r}, and {damaged} records of maps are damaged; 'topnav map check'")
    raise missing(connection, name)


def missing(connection: Connection, name: str) -> MissingError:
    """The error that lists what there is."""
    names = sorted(label(row) for row in rows(connection))
    return MissingError(f"no map {name!r}; maps: {names[:LISTED]}")


def exists(connection: Connection, name: str) -> bool:
    """Whether a map of that name is there."""
    return any(label(row) == name for row in rows(connection))


def records(connection: Connection) -> list[MapRecord]:
    """All maps by name, but those whose record is damaged."""
    good = [record_of(row) for row in rows(connection) if intact(maps, row)]
    return sorted(good, key=lambda record: record.name)


def create(connection: Connection, name: str, now_ns: int) -> MapRecord:
    """Make an empty map at revision 0."""
    if exists(connection, check_new_name(name)):
        raise ConflictError(f"map {name!r} exists already; read it, or delete it first")
    values = {"name": name, "revision": 0, "created_ns": now_ns, "changed_ns": now_ns}
    key = connection.execute(insert(maps).values(values)).inserted_primary_key
    assert key is not None
    record = MapRecord(int(key[0]), name, 0, now_ns, now_ns)
    save(connection, record)
    write_marks(connection, record.map_id, 0, Marks())
    return record


def save(connection: Connection, record: MapRecord) -> None:
    """Write the record of a map that exists."""
    connection.execute(OF_MAP, {**sealed(maps, asdict(record)), "of": record.map_id})


def rename(connection: Connection, name: str, new_name: str) -> MapRecord:
    """Give a map another name."""
    found = find(connection, name)
    if exists(connection, check_new_name(new_name)):
        raise ConflictError(f"map {new_name!r} exists already")
    renamed = replace(found, name=new_name)
    save(connection, renamed)
    return renamed


def remove(connection: Connection, name: str) -> int:
    """Delete a map with everything it owns; returns its last revision."""
    found = find(connection, name)
    for table in (inspections, marks, edges, nodes, revisions):
        connection.execute(delete(table).where(table.c.map_id == found.map_id))
    blobs.drop(connection, found.map_id)
    connection.execute(delete(maps).where(maps.c.map_id == found.map_id))
    return found.revision


def record_of(row: Row[Any]) -> MapRecord:
    """The record in a row; CorruptError when it is damaged."""
    if not intact(maps, row):
        name = label(row)
        raise CorruptError(f"map {name!r}: its record is damaged; 'topnav map repair {name}' mends it")
    return MapRecord(**{name: value for name, value in row._mapping.items() if name != "seal"})


def parse_marks(row: Row[Any] | None) -> Marks:
    """Places and rules from the row of their map; CorruptError when it is not what was written."""
    if row is None:
        raise CorruptError("places and rules: their record is missing")
    if not intact(marks, row):
        raise CorruptError("places and rules: their record does not match its checksum")
    return Marks.model_validate_json(row.record)


def write_marks(connection: Connection, map_id: int, revision: int, written: Marks) -> None:
    """Put places and rules into the place of those a map had."""
    values = {"map_id": map_id, "revision": revision, "record": written.model_dump_json()}
    connection.execute(delete(marks).where(marks.c.map_id == map_id))
    connection.execute(insert(marks).values(sealed(marks, values)))
