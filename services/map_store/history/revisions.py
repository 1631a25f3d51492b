"""Revisions of a map: what was done, by whom, and which one an undo takes back."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from sqlalchemy import Connection, Row, Select, delete, insert, select

from services.map_store.errors import CorruptError, MissingError
from services.map_store.history.comparison import Comparison, compare, rewind
from services.map_store.history.summaries import Summaries
from services.map_store.integrity.seals import intact, sealed
from services.map_store.storage import catalogue
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import Change, Graph, Step
from services.map_store.storage.rows import pack_history, pack_lost, unpack_steps, write_change
from services.map_store.storage.tables import revisions

INSERT = insert(revisions)


@dataclass(frozen=True)
class Revision:
    """One entry of a map's history.

    Attributes:
        author: who wrote it.
        steps: how many single changes it is made of; `summary` says which.
        undoes: the revision it took back.
        summary: what it did, in words; made from its steps when the history is listed.
    """

    revision: int
    author: str
    stamp_ns: int
    steps: int
    undoes: int | None
    summary: str = ""


def record(
    connection: Connection, found: MapRecord, entry: Revision, steps: tuple[Step, ...], change: Change
) -> MapRecord:
    """Write one revision: what it changed, the steps that led to it and those that lead back."""
    write_change(connection, found.map_id, entry.revision, change)
    content, sha256 = pack_history(steps, change.inverse)
    values = {
        "map_id": found.map_id,
        "revision": entry.revision,
        "author": entry.author,
        "stamp_ns": entry.stamp_ns,
        "undoes": entry.undoes,
        "steps": entry.steps,
        "sha256": sha256,
    }
    connection.execute(INSERT, {**sealed(revisions, values), "content": content})
    now = replace(
        found,
        revision=entry.revision,
        changed_ns=entry.stamp_ns,
        node_count=len(change.graph.nodes),
        edge_count=len(change.graph.edges),
    )
    catalogue.save(connection, now)
    return now


def entries(
    connection: Connection, found: MapRecord, before: int, limit: int, summaries: Summaries
) -> list[Revision]:
    """Up to `limit` revisions older than `before`, newest first; a damaged one says so in its summary."""
    newest = min(found.revision, before - 1)
    oldest = max(1, newest - limit + 1)
    query = _headers(found.map_id).where(revisions.c.revision.between(oldest, newest))
    rows = {row.revision: row for row in connection.execute(query)}
    listed = []
    for number in range(newest, oldest - 1, -1):
        row = rows.get(number)
        if row is None or not intact(revisions, row):
            listed.append(Revision(number, "", 0, 0, None, f"unreadable: {_lacks(row)}"))
            continue
        summary = summaries.of(connection, found.map_id, number, row.sha256)
        listed.append(Revision(number, row.author, row.stamp_ns, row.steps, row.undoes, summary))
    return listed


def last_standing(connection: Connection, found: MapRecord) -> int:
    """The newest revision that is neither an undo nor undone: calling undo twice goes back two.

    Everything after it is undone, so its inverse fits the graph as it is now. A damaged entry ends the
    search: it may be an undo, and of which revision is not known.
    """
    rows = iter(connection.execute(_headers(found.map_id).order_by(revisions.c.revision.desc())).all())
    undone: set[int] = set()
    for number in range(found.revision, 0, -1):
        row = next(rows, None)
        if row is None or row.revision != number or not intact(revisions, row):
            raise CorruptError(f"revision {number}: {_lacks(row)}; what is older cannot be undone")
        if row.undoes is not None:
            undone.add(row.undoes)
        elif number not in undone:
            return number
    raise MissingError("nothing left to undo")


def steps_of(connection: Connection, map_id: int, revision: int, inverse: bool) -> tuple[Step, ...]:
    """The steps of one revision, or those that lead back over it; CorruptError when they are damaged."""
    query = select(revisions).where(revisions.c.map_id == map_id, revisions.c.revision == revision)
    row = connection.execute(query).first()
    if row is None or not intact(revisions, row):
        raise CorruptError(f"revision {revision}: {_lacks(row)}")
    try:
        return unpack_steps(row.content, row.sha256, inverse)
    except CorruptError as error:
        raise type(error)(f"revision {revision}: {error}") from None


def compared(
    connection: Connection, found: MapRecord, newest: Graph, start: int, end: int | None
) -> tuple[int, Comparison]:
    """What leads from revision `start` to `end` (None = the newest), whichever is older.

    No old graph is kept: the history leads back from `newest`, the graph of the newest revision.

    Returns:
        The number of the end, and the comparison.

    Raises:
        MissingError: no such revision.
        CorruptError: a revision on the way back is damaged.
    """
    end = found.revision if end is None else end
    for number in (start, end):
        if not 0 <= number <= found.revision:
            known = f"revisions: 0 to {found.revision}"
            raise MissingError(f"map {found.name!r}: revision {number} does not exist; {known}")
    older, newer = sorted((start, end))
    after = rewind(newest, _inverses(connection, found.map_id, found.revision, newer))
    before = rewind(after, _inverses(connection, found.map_id, newer, older))
    return end, compare(before, after) if start <= end else compare(after, before)


def _inverses(connection: Connection, map_id: int, newer: int, older: int) -> Iterator[tuple[Step, ...]]:
    """The ways back over all revisions from `newer` to the one after `older`, each read when it is needed."""
    numbers = range(newer, older, -1)
    return (steps_of(connection, map_id, number, inverse=True) for number in numbers)


def give_up(connection: Connection, map_id: int, revision: int, now_ns: int) -> None:
    """Put an entry that says so in the place of one that is damaged."""
    same = revisions.c.map_id == map_id, revisions.c.revision == revision
    connection.execute(delete(revisions).where(*same))
    content, sha256 = pack_lost()
    values = {"map_id": map_id, "revision": revision, "author": "", "stamp_ns": now_ns, "undoes": None}
    row = sealed(revisions, {**values, "steps": 0, "sha256": sha256})
    connection.execute(INSERT, {**row, "content": content})


def _headers(map_id: int) -> Select[Any]:
    """All of a map's entries without their steps."""
    kept = [column for column in revisions.columns if column.name != "content"]
    return select(*kept).where(revisions.c.map_id == map_id)


def _lacks(row: Row[Any] | None) -> str:
    return "its record is missing" if row is None else "its record does not match its checksum"
