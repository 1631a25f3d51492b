"""Maps by name: find, list, create, rename, delete. Every function works inside the caller's transaction."""

from dataclasses import dataclass

from sqlalchemy import Connection, Row, delete, func, insert, select, update

from services.map_store import blobs
from services.map_store.errors import ConflictError, InvalidError, MissingError
from services.map_store.tables import edges, maps, nodes, revisions
from shared.topics import NAME

LISTED = 20
"""Names given in an error."""


@dataclass(frozen=True)
class MapSummary:
    """One line of the list of maps; times are nanoseconds since the Unix epoch."""

    name: str
    revision: int
    nodes: int
    edges: int
    created_ns: int
    changed_ns: int


def check_name(name: str) -> str:
    """Return `name`, or raise InvalidError: the rule of the bus holds everywhere."""
    if not NAME.match(name):
        raise InvalidError(f"map name must match [a-z0-9_-]{{1,64}}, got {name[:80]!r}")
    return name


def find(connection: Connection, name: str) -> Row[int, int]:
    """`map_id` and `revision` of a map; MissingError lists what there is."""
    check_name(name)
    query = select(maps.c.map_id, maps.c.revision).where(maps.c.name == name)
    row = connection.execute(query).first()
    if row is None:
        names = connection.execute(select(maps.c.name).order_by(maps.c.name).limit(LISTED)).scalars().all()
        raise MissingError(f"no map {name!r}; maps: {list(names)}")
    return row


def exists(connection: Connection, name: str) -> bool:
    """Whether a map of that name is there."""
    return connection.execute(select(maps.c.map_id).where(maps.c.name == name)).first() is not None


def summaries(connection: Connection, name: str | None = None) -> list[MapSummary]:
    """All maps by name, or the one that is named."""
    node_count = select(func.count()).where(nodes.c.map_id == maps.c.map_id).scalar_subquery()
    edge_count = select(func.count()).where(edges.c.map_id == maps.c.map_id).scalar_subquery()
    query = select(
        maps.c.name, maps.c.revision, node_count, edge_count, maps.c.created_ns, maps.c.changed_ns
    ).order_by(maps.c.name)
    if name is not None:
        query = query.where(maps.c.name == name)
    return [MapSummary(*row) for row in connection.execute(query)]


def create(connection: Connection, name: str, now_ns: int) -> int:
    """Make an empty map at revision 0 and return its id."""
    if exists(connection, check_name(name)):
        raise ConflictError(f"map {name!r} exists already; read it, or delete it first")
    values = {"name": name, "revision": 0, "created_ns": now_ns, "changed_ns": now_ns}
    key = connection.execute(insert(maps).values(values)).inserted_primary_key
    assert key is not None
    return int(key[0])


def rename(connection: Connection, name: str, new_name: str) -> int:
    """Give a map another name; returns its revision."""
    found = find(connection, name)
    if exists(connection, check_name(new_name)):
        raise ConflictError(f"map {new_name!r} exists already")
    connection.execute(update(maps).where(maps.c.map_id == found.map_id).values(name=new_name))
    return int(found.revision)


def remove(connection: Connection, name: str) -> int:
    """Delete a map with everything it owns; returns its last revision."""
    found = find(connection, name)
    for table in (edges, nodes, revisions):
        connection.execute(delete(table).where(table.c.map_id == found.map_id))
    blobs.drop(connection, found.map_id)
    connection.execute(delete(maps).where(maps.c.map_id == found.map_id))
    return int(found.revision)
