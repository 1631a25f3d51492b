"""Content-addressed bytes: kept once, named by their checksum, checked on every read."""

import hashlib
from collections.abc import Iterable, Mapping, Set
from typing import Any

from sqlalchemy import Connection, Select, bindparam, delete, func, insert, select, update

from services.map_store.errors import CorruptError, MissingError
from services.map_store.integrity.seals import matches
from services.map_store.storage import tables
from shared.messages.features import Features
from shared.topics import FEATURES
from shared.wire import WireError, decode, encode

KNOWN = select(tables.blobs.c.sha256).where(tables.blobs.c.sha256.in_(bindparam("names", expanding=True)))
LINKED = select(tables.map_blobs.c.sha256).where(
    tables.map_blobs.c.map_id == bindparam("of"),
    tables.map_blobs.c.sha256.in_(bindparam("names", expanding=True)),
)
DATA = select(tables.blobs.c.data).where(tables.blobs.c.sha256 == bindparam("name"))
CHUNK = 500
"""Values in one SQL list; SQLite's oldest limit is 999."""


def checksum(data: bytes) -> str:
    """SHA-256 as 64 hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def pack_features(features: Features) -> bytes:
    """The features as stored: the wire's bytes without the thumbnail, which is a blob of its own."""
    return encode(features.model_copy(update={"thumbnail": b""}))


def unpack_features(data: bytes) -> Features:
    """Features from stored bytes; CorruptError when they are not."""
    try:
        return decode(Features, data, FEATURES.max_bytes)
    except WireError as error:
        raise CorruptError(f"stored features: {error}") from error


def put(connection: Connection, map_id: int, contents: Mapping[str, bytes]) -> None:
    """Keep `contents` (checksum -> bytes) for a map; good bytes are not written again, damaged ones are."""
    names = list(contents)
    known = _existing(connection, KNOWN, names)
    for name in known:
        _heal(connection, name, contents[name])
    rows = [{"sha256": n, "size": len(contents[n]), "data": contents[n]} for n in names if n not in known]
    if rows:
        connection.execute(insert(tables.blobs), rows)
    _link(connection, map_id, names)


def share(connection: Connection, map_id: int, names: Set[str]) -> None:
    """Keep blobs of another map for this one as well; MissingError when they are gone with that map."""
    there = _existing(connection, KNOWN, sorted(names))
    if gone := names - there:
        raise MissingError(f"{len(gone)} blobs are no longer there; was the map they belong to deleted?")
    _link(connection, map_id, sorted(names))


def _link(connection: Connection, map_id: int, names: list[str]) -> None:
    linked = _existing(connection, LINKED, names, of=map_id)
    links = [{"map_id": map_id, "sha256": name} for name in names if name not in linked]
    if links:
        connection.execute(insert(tables.map_blobs), links)


def _heal(connection: Connection, name: str, data: bytes) -> None:
    try:
        get(connection, name)
    except CorruptError:
        blobs = tables.blobs
        connection.execute(update(blobs).where(blobs.c.sha256 == name).values(data=data, size=len(data)))


def get(connection: Connection, name: str) -> bytes:
    """Read one blob; CorruptError when it is gone or its checksum does not match."""
    data = connection.execute(DATA, {"name": name}).scalar()
    if data is None:
        raise CorruptError(f"blob {name[:12]} is missing")
    if not matches(data, name):
        raise CorruptError(f"blob {name[:12]} does not match its checksum")
    return bytes(data)


def owned(connection: Connection, map_id: int) -> set[str]:
    """Checksums of the blobs of a map, those of its history included."""
    query = select(tables.map_blobs.c.sha256).where(tables.map_blobs.c.map_id == map_id)
    return {name for name in connection.execute(query).scalars() if isinstance(name, str)}


def unreadable(connection: Connection, names: Iterable[str]) -> dict[str, str]:
    """Those of these blobs that are missing or damaged, with the reason."""
    reasons = {}
    for name in sorted(names):
        try:
            get(connection, name)
        except CorruptError as error:
            reasons[name] = str(error)
    return reasons


def given_up(connection: Connection, name: str) -> bool:
    """Whether a repair emptied this blob because its bytes were damaged."""
    data = connection.execute(DATA, {"name": name}).scalar()
    return data == b""


def give_up(connection: Connection, name: str) -> None:
    """Empty a blob that is lost, so that it is known as such; histories go on referring to it."""
    values: Mapping[str, object] = {"data": b"", "size": 0}
    kept = tables.blobs
    written = connection.execute(update(kept).where(kept.c.sha256 == name).values(values))
    if written.rowcount == 0:
        connection.execute(insert(kept).values({**values, "sha256": name}))


def sizes(connection: Connection, names: Iterable[str]) -> int:
    """Bytes of all named blobs together."""
    wanted, total = list(names), 0
    for start in range(0, len(wanted), CHUNK):
        chunk = tables.blobs.c.sha256.in_(wanted[start : start + CHUNK])
        total += sum(connection.execute(select(func.length(tables.blobs.c.data)).where(chunk)).scalars())
    return total


def name_again(connection: Connection) -> None:
    """Keep blobs whose name was damaged under the name that their content says, where that one is missed."""
    kept, links = tables.blobs, tables.map_blobs
    missed = select(links.c.sha256).where(links.c.sha256.not_in(select(kept.c.sha256)))
    names = set(connection.execute(missed).scalars())
    if not names:
        return
    for row in connection.execute(select(kept).where(kept.c.sha256.not_in(select(links.c.sha256)))).all():
        name = checksum(row.data) if isinstance(row.data, bytes) else ""
        if name in names:
            connection.execute(insert(kept).values(sha256=name, size=len(row.data), data=row.data))
            names.discard(name)


def wrong_sizes(connection: Connection, map_id: int) -> list[str]:
    """Checksums of the map's blobs whose recorded size is not theirs."""
    mine = select(tables.map_blobs.c.sha256).where(tables.map_blobs.c.map_id == map_id)
    length = func.length(tables.blobs.c.data)
    query = select(tables.blobs.c.sha256).where(tables.blobs.c.size != length)
    return list(connection.execute(query.where(tables.blobs.c.sha256.in_(mine))).scalars())


def measure(connection: Connection) -> None:
    """Record the size of every blob anew."""
    connection.execute(update(tables.blobs).values(size=func.length(tables.blobs.c.data)))


def relink(connection: Connection, map_id: int, names: Set[str]) -> int:
    """Link a map to those of these blobs that are there, and unlink what is not; returns how many it was."""
    links = tables.map_blobs
    there = _existing(connection, KNOWN, sorted(names))
    missing = there - owned(connection, map_id)
    dangling = links.c.sha256.not_in(select(tables.blobs.c.sha256))
    cut = connection.execute(delete(links).where(links.c.map_id == map_id, dangling)).rowcount
    if missing:
        rows = [{"map_id": map_id, "sha256": name} for name in sorted(missing)]
        connection.execute(insert(links), rows)
    return max(cut, len(missing))


def drop(connection: Connection, map_id: int) -> None:
    """Forget a map's blobs, and the bytes that no other map uses."""
    connection.execute(delete(tables.map_blobs).where(tables.map_blobs.c.map_id == map_id))
    used = select(tables.map_blobs.c.sha256).where(tables.map_blobs.c.sha256 == tables.blobs.c.sha256)
    connection.execute(delete(tables.blobs).where(~used.exists()))


def _existing(connection: Connection, query: Select[Any], names: list[str], **where: int) -> set[str]:
    found: set[str] = set()
    for start in range(0, len(names), CHUNK):
        chunk = {"names": names[start : start + CHUNK], **where}
        found.update(str(name) for name in connection.execute(query, chunk).scalars())
    return found
