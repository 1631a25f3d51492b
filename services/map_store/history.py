"""Revisions of a map: what was done, by whom, and which one an undo takes back."""

from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import Connection, insert, select

from services.map_store.errors import CorruptError, MissingError
from services.map_store.graph import Change, Step
from services.map_store.rows import pack_history, unpack_inverse
from services.map_store.summaries import Summaries
from services.map_store.tables import revisions


@dataclass(frozen=True)
class Revision:
    """One entry of a map's history.

    Attributes:
        steps: how many it had.
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
    connection: Connection, map_id: int, entry: Revision, steps: tuple[Step, ...], change: Change
) -> None:
    """Write one revision with the steps that led to it and those that lead back."""
    content, sha256 = pack_history(steps, change.inverse)
    connection.execute(
        insert(revisions).values(
            map_id=map_id,
            revision=entry.revision,
            author=entry.author,
            stamp_ns=entry.stamp_ns,
            undoes=entry.undoes,
            steps=entry.steps,
            content=content,
            sha256=sha256,
        )
    )


def entries(
    connection: Connection, map_id: int, before: int, limit: int, summaries: Summaries
) -> list[Revision]:
    """Up to `limit` revisions older than `before`, newest first."""
    table = revisions.c
    query = (
        select(table.revision, table.author, table.stamp_ns, table.steps, table.undoes, table.sha256)
        .where(table.map_id == map_id, table.revision < before)
        .order_by(table.revision.desc())
        .limit(limit)
    )
    return [
        Revision(*row[:-1], summary=summaries.of(connection, map_id, row.revision, row.sha256))
        for row in connection.execute(query).all()
    ]


def last_standing(connection: Connection, map_id: int) -> int:
    """The newest revision that is neither an undo nor undone: calling undo twice goes back two.

    Everything after it is undone, so its inverse fits the graph as it is now.
    """
    undone = select(revisions.c.undoes).where(revisions.c.map_id == map_id, revisions.c.undoes.is_not(None))
    query = (
        select(revisions.c.revision)
        .where(
            revisions.c.map_id == map_id,
            revisions.c.undoes.is_(None),
            revisions.c.revision.not_in(undone),
        )
        .order_by(revisions.c.revision.desc())
        .limit(1)
    )
    found = connection.execute(query).scalar()
    if found is None:
        raise MissingError("nothing left to undo")
    return int(found)


def inverse_of(connection: Connection, map_id: int, revision: int) -> tuple[Step, ...]:
    """The steps that lead back over one revision."""
    query = select(revisions.c.content, revisions.c.sha256).where(
        revisions.c.map_id == map_id, revisions.c.revision == revision
    )
    row = connection.execute(query).first()
    if row is None:
        raise MissingError(f"revision {revision} does not exist")
    try:
        return unpack_inverse(row.content, row.sha256)
    except CorruptError as error:
        raise CorruptError(f"revision {revision}: {error}") from None


def inverses(connection: Connection, map_id: int, newer: int, older: int) -> Iterator[tuple[Step, ...]]:
    """The ways back over all revisions from `newer` to the one after `older`, each read when it is needed."""
    return (inverse_of(connection, map_id, revision) for revision in range(newer, older, -1))
