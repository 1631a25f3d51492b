"""Maps in a database: transactions that are all or nothing, then one delta for everyone who follows."""

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from sqlalchemy import Connection, update

from services.map_store import blobs, catalogue, history
from services.map_store.catalogue import MapSummary
from services.map_store.contents import Contents
from services.map_store.database import Database
from services.map_store.errors import ConflictError, InvalidError
from services.map_store.graph import Change, Graph, Step, apply
from services.map_store.graphs import Graphs
from services.map_store.history import Revision
from services.map_store.operations import prepare
from services.map_store.past import Past
from services.map_store.rows import write_change
from services.map_store.summaries import Summaries
from services.map_store.tables import maps
from shared.messages.maps import MapDelta, Operation


class MapStore:
    """The maps. Safe from any thread; `changed` is called in the order of the commits.

    Args:
        database: where they are kept.
        now_ns: clock, nanoseconds since the Unix epoch.
        changed: gets every delta once it is committed; it must only store it.
    """

    def __init__(
        self, database: Database, now_ns: Callable[[], int], changed: Callable[[MapDelta], None]
    ) -> None:
        self.database = database
        self._graphs = Graphs()
        self.contents = Contents(database, self._graphs)
        self.past = Past(database, self._graphs)
        self._summaries = Summaries()
        self._now_ns, self._changed = now_ns, changed
        self._writing = threading.Lock()

    def summaries(self) -> list[MapSummary]:
        """All maps by name."""
        with self.database.read() as connection:
            return catalogue.summaries(connection)

    def summary(self, name: str) -> MapSummary:
        """One map."""
        with self.database.read() as connection:
            catalogue.find(connection, name)
            return catalogue.summaries(connection, name)[0]

    def graph(self, name: str) -> tuple[int, Graph]:
        """The newest revision and its graph."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            return found.revision, self._graphs.get(connection, found)

    def revisions(self, name: str, before: int, limit: int) -> list[Revision]:
        """The newest `limit` revisions older than `before`, newest first."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            return history.entries(connection, found.map_id, before, limit, self._summaries)

    def create(self, name: str) -> int:
        """Make an empty map; returns its revision, 0. ConflictError when it exists."""
        with self._write() as (connection, deltas):
            catalogue.create(connection, name, self._now_ns())
            deltas.append(MapDelta(map=name, revision=0, reset=True))
        return 0

    def delete(self, name: str) -> None:
        """Delete a map with its history."""
        with self._write() as (connection, deltas):
            revision = catalogue.remove(connection, name)
            deltas.append(MapDelta(map=name, revision=revision, reset=True))

    def rename(self, name: str, new_name: str) -> None:
        """Give a map another name; followers of both are told to read again."""
        with self._write() as (connection, deltas):
            revision = catalogue.rename(connection, name, new_name)
            deltas += [MapDelta(map=each, revision=revision, reset=True) for each in (name, new_name)]

    def transact(
        self,
        name: str,
        operations: Sequence[Operation],
        author: str = "",
        base_revision: int | None = None,
    ) -> int:
        """Apply all operations or none; returns the new revision.

        Raises:
            MissingError, ConflictError, InvalidError: nothing was changed; the text says why.
        """
        if not operations:
            raise InvalidError("a transaction needs at least one operation")
        prepared = prepare(operations)
        with self._write() as (connection, deltas):
            found = catalogue.find(connection, name)
            _check_base(name, found.revision, base_revision)
            change = apply(self._graphs.get(connection, found), prepared.steps)
            blobs.put(connection, found.map_id, prepared.contents)
            entry = Revision(found.revision + 1, author, self._now_ns(), len(prepared.steps), None)
            self._commit(connection, found.map_id, entry, prepared.steps, change)
            deltas.append(
                MapDelta(
                    stamp_ns=entry.stamp_ns,
                    map=name,
                    revision=entry.revision,
                    author=author,
                    operations=prepared.published,
                )
            )
        self._graphs.remember(found.map_id, entry.revision, change.graph)
        return entry.revision

    def undo(self, name: str, author: str = "", base_revision: int | None = None) -> tuple[int, int]:
        """Take back the newest revision that still stands, as a new one; returns (new, undone)."""
        with self._write() as (connection, deltas):
            found = catalogue.find(connection, name)
            _check_base(name, found.revision, base_revision)
            undone = history.last_standing(connection, found.map_id)
            steps = history.inverse_of(connection, found.map_id, undone)
            change = apply(self._graphs.get(connection, found), steps)
            entry = Revision(found.revision + 1, author, self._now_ns(), len(steps), undone)
            self._commit(connection, found.map_id, entry, steps, change)
            deltas.append(MapDelta(map=name, revision=entry.revision, author=author, reset=True))
        return entry.revision, undone

    def restore(
        self, name: str, steps: tuple[Step, ...], read_blob: Callable[[str], bytes], author: str
    ) -> int:
        """Make a map at revision 1; `read_blob` gives the bytes of each checksum that `steps` name."""
        change = apply(Graph(), steps)
        with self._write() as (connection, deltas):
            entry = Revision(1, author, self._now_ns(), len(steps), None)
            map_id = catalogue.create(connection, name, entry.stamp_ns)
            for place in change.graph.places.values():
                named = [sha256 for sha256 in (place.features, place.thumbnail) if sha256]
                blobs.put(connection, map_id, {sha256: read_blob(sha256) for sha256 in named})
            self._commit(connection, map_id, entry, steps, change)
            deltas.append(MapDelta(map=name, revision=1, author=author, reset=True))
        return entry.revision

    @staticmethod
    def _commit(
        connection: Connection, map_id: int, entry: Revision, steps: tuple[Step, ...], change: Change
    ) -> None:
        write_change(connection, map_id, entry.revision, change)
        history.record(connection, map_id, entry, steps, change)
        changed = {"revision": entry.revision, "changed_ns": entry.stamp_ns}
        connection.execute(update(maps).where(maps.c.map_id == map_id).values(changed))

    @contextmanager
    def _write(self) -> Iterator[tuple[Connection, list[MapDelta]]]:
        """One write; the deltas put into the list are told only once it is committed, still in order."""
        deltas: list[MapDelta] = []
        with self._writing:
            with self.database.write() as connection:
                yield connection, deltas
            for delta in deltas:
                self._changed(delta)


def _check_base(name: str, revision: int, base_revision: int | None) -> None:
    if base_revision is not None and base_revision != revision:
        raise ConflictError(
            f"map {name!r} is at revision {revision}, not {base_revision}; read it again and decide anew"
        )
