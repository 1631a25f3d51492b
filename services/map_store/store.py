"""Maps in a database: transactions that are all or nothing, then one delta for everyone who follows."""

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from sqlalchemy import Connection

from services.map_store.errors import ConflictError, InvalidError, MissingError
from services.map_store.history import revisions as history
from services.map_store.history.comparison import Comparison
from services.map_store.history.revisions import Revision
from services.map_store.history.summaries import Summaries
from services.map_store.integrity.repair import Repaired, relink_all, repair
from services.map_store.storage import answers, blobs, catalogue
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.contents import Contents
from services.map_store.storage.database import Database
from services.map_store.storage.graph import Graph, Step, added_by, apply
from services.map_store.storage.graphs import Graphs
from services.map_store.storage.missions import follow_rename
from services.map_store.storage.operations import prepare
from services.map_store.tasks import records
from shared.mapgraph.marks import gaps
from shared.messages.maps import MapDelta, Operation
from shared.messages.places import PutRoute


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
        self._summaries = Summaries()
        self._now_ns, self._changed = now_ns, changed
        self._writing = threading.Lock()

    def summaries(self) -> list[MapRecord]:
        """All maps by name, but those whose record is damaged."""
        with self.database.read() as connection:
            return catalogue.records(connection)

    def summary(self, name: str) -> MapRecord:
        """One map."""
        with self.database.read() as connection:
            return catalogue.find(connection, name)

    def graph(self, name: str) -> tuple[int, Graph]:
        """The newest revision and its graph."""
        found, graph = self.recorded_graph(name)
        return found.revision, graph

    def recorded_graph(self, name: str) -> tuple[MapRecord, Graph]:
        """The map's record and the graph that belongs to it."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            return found, self._graphs.get(connection, found)

    def revisions(self, name: str, before: int, limit: int) -> list[Revision]:
        """The newest `limit` revisions older than `before`, newest first."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            return history.entries(connection, found, before, limit, self._summaries)

    def compare(self, name: str, start: int, end: int | None) -> tuple[int, Comparison]:
        """What leads from revision `start` to `end`, by default the newest; returns the end's number too."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            return history.compared(connection, found, self._graphs.get(connection, found), start, end)

    def create(self, name: str, request_id: str = "") -> int:
        """Make an empty map; returns its revision, 0. ConflictError when it exists, not by this request."""
        with self._write() as (connection, deltas):
            if answers.revision_of(connection, name, request_id) is not None:
                return 0
            catalogue.create(connection, name, self._now_ns())
            answers.keep(connection, name, request_id, 0)
            deltas.append(MapDelta(map=name, revision=0, reset=True))
        return 0

    def delete(self, name: str) -> None:
        """Delete a map with its history."""
        with self._write() as (connection, deltas):
            revision = catalogue.remove(connection, name)
            deltas.append(MapDelta(map=name, revision=revision, reset=True))

    def rename(self, name: str, new_name: str) -> None:
        """Give a map another name, also in missions and tasks in it; followers of both must read again."""
        with self._write() as (connection, deltas):
            found = catalogue.rename(connection, name, new_name)
            follow_rename(connection, name, new_name)
            records.follow_rename(connection, name, new_name)
            # In this order: who follows to the new name, which may be gone again, finds no reset there.
            deltas.append(MapDelta(map=new_name, revision=found.revision, reset=True))
            deltas.append(MapDelta(map=name, revision=found.revision, reset=True, renamed_to=new_name))

    def transact(
        self,
        name: str,
        operations: Sequence[Operation],
        author: str = "",
        base_revision: int | None = None,
        request_id: str = "",
    ) -> int:
        """Apply all operations or none; returns the new revision, or that of the same request before.

        Raises:
            MissingError, ConflictError, InvalidError: nothing was changed; the text says why.
        """
        if not operations:
            raise InvalidError("a transaction needs at least one operation")
        prepared = prepare(operations)
        with self._write() as (connection, deltas):
            if (answered := answers.revision_of(connection, name, request_id)) is not None:
                return answered
            found = catalogue.find(connection, name)
            _check_base(name, found.revision, base_revision)
            blobs.put(connection, found.map_id, prepared.contents)
            entry, graph = self._commit(connection, found, prepared.steps, author)
            _check_routes(name, prepared.steps, graph)
            answers.keep(connection, name, request_id, entry.revision)
            deltas.append(
                MapDelta(
                    stamp_ns=entry.stamp_ns,
                    map=name,
                    revision=entry.revision,
                    author=author,
                    operations=prepared.published,
                )
            )
        self._graphs.remember(found.map_id, entry.revision, graph)
        return entry.revision

    def undo(self, name: str, author: str = "", base_revision: int | None = None) -> tuple[int, int]:
        """Take back the newest revision that still stands, as a new one; returns (new, undone)."""
        with self._write() as (connection, deltas):
            found = catalogue.find(connection, name)
            _check_base(name, found.revision, base_revision)
            undone = history.last_standing(connection, found)
            steps = history.steps_of(connection, found.map_id, undone, inverse=True)
            entry, _ = self._commit(connection, found, steps, author, undone)
            deltas.append(MapDelta(map=name, revision=entry.revision, author=author, reset=True))
        return entry.revision, undone

    def add_stored(self, base: MapRecord, steps: tuple[Step, ...], author: str) -> int:
        """Apply steps whose blobs are kept for another map to `base` as it was read; all or none.

        Returns the new revision; ConflictError when the map has changed or is another one of that name.
        """
        with self._write() as (connection, deltas):
            found = catalogue.find(connection, base.name)
            if found.map_id != base.map_id:
                raise ConflictError(
                    f"map {base.name!r} is another one than was read, it was deleted or renamed meanwhile; "
                    "read it again and decide anew"
                )
            _check_base(found.name, found.revision, base.revision)
            names = {sha256 for stored in added_by(steps) for sha256 in stored.blobs}
            blobs.share(connection, found.map_id, names)
            entry, _ = self._commit(connection, found, steps, author)
            deltas.append(MapDelta(map=found.name, revision=entry.revision, author=author, reset=True))
        return entry.revision

    def restore(
        self, name: str, steps: tuple[Step, ...], read_blob: Callable[[str], bytes], author: str
    ) -> int:
        """Make a map at revision 1; `read_blob` gives the bytes of each checksum that `steps` name."""
        with self._write() as (connection, deltas):
            found = catalogue.create(connection, name, self._now_ns())
            for stored in added_by(steps):
                blobs.put(connection, found.map_id, {sha256: read_blob(sha256) for sha256 in stored.blobs})
            self._commit(connection, found, steps, author)
            deltas.append(MapDelta(map=name, revision=1, author=author, reset=True))
        return 1

    def repair(self, name: str, author: str = "") -> Repaired:
        """Mend what is damaged in a map; what cannot be mended is removed, as a new revision.

        Raises:
            CorruptError: more of the file is damaged than a repair can mend; nothing was changed.
        """
        first = []
        if self.database.inspect():
            self.database.rebuild_indexes(then=relink_all)
            first.append("indexes of the file: written anew from their tables")
        with self._write() as (connection, deltas):
            found, done = repair(connection, name, author, self._now_ns())
            deltas.append(MapDelta(map=found.name, revision=found.revision, author=author, reset=True))
        self._graphs.forget(found.map_id)
        return Repaired(found.name, found.revision, (*first, *done))

    def _commit(
        self,
        connection: Connection,
        found: MapRecord,
        steps: tuple[Step, ...],
        author: str,
        undoes: int | None = None,
    ) -> tuple[Revision, Graph]:
        """Write steps as the next revision; returns its entry and the graph it leads to."""
        change = apply(self._graphs.get(connection, found), steps)
        entry = Revision(found.revision + 1, author, self._now_ns(), len(steps), undoes)
        history.record(connection, found, entry, steps, change)
        return entry, change.graph

    @contextmanager
    def _write(self) -> Iterator[tuple[Connection, list[MapDelta]]]:
        """One write; the deltas put into the list are told only once it is committed, still in order."""
        deltas: list[MapDelta] = []
        with self._writing:
            with self.database.write() as connection:
                yield connection, deltas
            for delta in deltas:
                self._changed(delta)


def _check_routes(name: str, steps: Sequence[Step], graph: Graph) -> None:
    """A route that is put anew has no gap; undo, imports and merges keep one as it was."""
    for step in steps:
        if isinstance(step, PutRoute) and (missing := gaps(step.route, graph.edges)):
            a, b = missing[0]
            raise MissingError(f"map {name!r}, route {step.route.name!r}: edge {a}-{b} does not exist")


def _check_base(name: str, revision: int, base_revision: int | None) -> None:
    if base_revision is not None and base_revision != revision:
        raise ConflictError(
            f"map {name!r} is at revision {revision}, not {base_revision}; read it again and decide anew"
        )
