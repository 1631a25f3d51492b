"""Maps in a database: transactions that are all or nothing, then one delta for everyone who follows."""

import logging
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from sqlalchemy import Connection, select, update

from services.map_store import blobs, catalogue, history
from services.map_store.database import Database
from services.map_store.errors import ConflictError, CorruptError, InvalidError, MapError, MissingError
from services.map_store.graph import AddPlace, Change, Graph, Place, Step, apply
from services.map_store.rows import read_graph, write_change
from services.map_store.tables import maps, nodes
from shared.messages.features import Features
from shared.messages.maps import AddNode, MapDelta, NodeFeatures, Operation

log = logging.getLogger(__name__)

CACHED_MAPS = 32
MAX_FEATURES_BYTES = 400_000_000
"""Largest answer to `features`; the bus carries 512 MB."""


class MapStore:
    """The maps. Safe from any thread; `changed` is called in the order of the commits.

    Args:
        database: where they are kept.
        now_ns: clock, nanoseconds since the Unix epoch.
        changed: gets every delta after it is committed; it must only store it.
    """

    def __init__(
        self, database: Database, now_ns: Callable[[], int], changed: Callable[[MapDelta], None]
    ) -> None:
        self.database = database
        self._now_ns, self._changed = now_ns, changed
        self._cache: OrderedDict[int, tuple[int, Graph]] = OrderedDict()
        self._cache_lock = threading.Lock()
        self._writing = threading.RLock()

    def summaries(self) -> list[catalogue.MapSummary]:
        """All maps."""
        with self.database.read() as connection:
            return catalogue.summaries(connection)

    def summary(self, name: str) -> catalogue.MapSummary:
        """One map."""
        with self.database.read() as connection:
            catalogue.find(connection, name)
            return catalogue.summaries(connection, name)[0]

    def create(self, name: str) -> int:
        """Make an empty map; returns its revision, 0. ConflictError when it exists."""
        with self._transaction() as connection:
            catalogue.create(connection, name, self._now_ns())
            self._announce(MapDelta(map=name, revision=0, reset=True))
        return 0

    def delete(self, name: str) -> None:
        """Delete a map with its history."""
        with self._transaction() as connection:
            revision = catalogue.remove(connection, name)
            self._announce(MapDelta(map=name, revision=revision, reset=True))

    def rename(self, name: str, new_name: str) -> None:
        """Give a map another name; both names are announced as reset."""
        with self._transaction() as connection:
            revision = catalogue.rename(connection, name, new_name)
            self._announce(
                MapDelta(map=name, revision=revision, reset=True),
                MapDelta(map=new_name, revision=revision, reset=True),
            )

    def graph(self, name: str) -> tuple[int, Graph]:
        """The newest revision and its graph."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            return found.revision, self._graph(connection, found.map_id, found.revision)

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
        steps, contents, published = _stored_form(operations)
        with self._transaction() as connection:
            found = catalogue.find(connection, name)
            _check_base(name, found.revision, base_revision)
            change = apply(self._graph(connection, found.map_id, found.revision), steps)
            blobs.put(connection, found.map_id, contents)
            entry = history.Revision(found.revision + 1, author, self._now_ns(), len(steps), None)
            self._commit(connection, found.map_id, entry, steps, change)
            delta = MapDelta(map=name, revision=entry.revision, author=author, operations=published)
            self._announce(delta.model_copy(update={"stamp_ns": entry.stamp_ns}))
        return entry.revision

    def undo(self, name: str, author: str = "", base_revision: int | None = None) -> tuple[int, int]:
        """Take back the newest revision that still stands, as a new one; returns (new, undone)."""
        with self._transaction() as connection:
            found = catalogue.find(connection, name)
            _check_base(name, found.revision, base_revision)
            undone = history.last_standing(connection, found.map_id)
            _, steps = history.steps_of(connection, found.map_id, undone)
            change = apply(self._graph(connection, found.map_id, found.revision), steps)
            entry = history.Revision(found.revision + 1, author, self._now_ns(), len(steps), undone)
            self._commit(connection, found.map_id, entry, steps, change)
            self._announce(MapDelta(map=name, revision=entry.revision, author=author, reset=True))
        return entry.revision, undone

    def restore(
        self, name: str, steps: tuple[Step, ...], read_blob: Callable[[str], bytes], author: str
    ) -> int:
        """Make a map from an archive whose steps are checked; `read_blob` gives the bytes of a checksum."""
        change = apply(Graph(), steps)
        with self._transaction() as connection:
            now_ns = self._now_ns()
            map_id = catalogue.create(connection, name, now_ns)
            for place in change.graph.places.values():
                names = [name for name in (place.features, place.thumbnail) if name]
                blobs.put(connection, map_id, {name: read_blob(name) for name in names})
            self._commit(
                connection, map_id, history.Revision(1, author, now_ns, len(steps), None), steps, change
            )
            self._announce(MapDelta(map=name, revision=1, author=author, reset=True))
        return 1

    def revisions(self, name: str, before: int, limit: int) -> list[history.Revision]:
        """The newest `limit` revisions older than `before`, newest first."""
        with self.database.read() as connection:
            return history.entries(connection, catalogue.find(connection, name).map_id, before, limit)

    def features(self, name: str, node_ids: Sequence[int]) -> tuple[int, tuple[NodeFeatures, ...]]:
        """The revision and the features of `node_ids`, of all nodes when empty; quarantined ones left out."""
        damaged: dict[int, str] = {}
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            graph = self._graph(connection, found.map_id, found.revision)
            places = [_place(graph, name, node_id) for node_id in (node_ids or sorted(graph.places))]
            size = blobs.sizes(connection, {place.features for place in places})
            if size > MAX_FEATURES_BYTES:
                raise InvalidError(f"{size} bytes of features; ask for fewer nodes at a time")
            answers = []
            for place in places:
                try:
                    features = blobs.unpack_features(blobs.get(connection, place.features))
                    answers.append(NodeFeatures(node_id=place.node.node_id, features=features))
                except CorruptError as error:
                    damaged[place.node.node_id] = str(error)
        self._quarantine(name, found.map_id, damaged)
        return found.revision, tuple(answers)

    def blob(self, name: str, node_id: int, kind: str) -> bytes:
        """Bytes of a node's "features" or "thumbnail"; b"" when it has no thumbnail."""
        with self.database.read() as connection:
            found = catalogue.find(connection, name)
            place = _place(self._graph(connection, found.map_id, found.revision), name, node_id)
            content = place.thumbnail if kind == "thumbnail" else place.features
            try:
                return blobs.get(connection, content) if content else b""
            except CorruptError as error:
                problem = f"map {name!r}, node {node_id}: {kind}: {error}; delete the node or import a backup"
        if kind == "features":
            self._quarantine(name, found.map_id, {node_id: problem})
        raise CorruptError(problem)

    def _commit(
        self,
        connection: Connection,
        map_id: int,
        entry: history.Revision,
        steps: tuple[Step, ...],
        change: Change,
    ) -> None:
        write_change(connection, map_id, entry.revision, change)
        history.record(connection, map_id, entry, steps, change)
        changed = {"revision": entry.revision, "changed_ns": entry.stamp_ns}
        connection.execute(update(maps).where(maps.c.map_id == map_id).values(changed))
        self._after.append(lambda: self._remember(map_id, entry.revision, change.graph))

    @contextmanager
    def _transaction(self) -> Iterator[Connection]:
        """One write; what was put in `_after` happens only once it is committed, still in order."""
        with self._writing:
            self._after: list[Callable[[], None]] = []
            with self.database.write() as connection:
                yield connection
            for action in self._after:
                action()

    def _announce(self, *deltas: MapDelta) -> None:
        for delta in deltas:
            self._after.append(lambda delta=delta: self._changed(delta))  # type: ignore[misc]

    def _graph(self, connection: Connection, map_id: int, revision: int) -> Graph:
        with self._cache_lock:
            cached = self._cache.get(map_id)
        if cached is not None and cached[0] == revision:
            return cached[1]
        graph = read_graph(connection, map_id)
        self._remember(map_id, revision, graph)
        return graph

    def _remember(self, map_id: int, revision: int, graph: Graph) -> None:
        with self._cache_lock:
            cached = self._cache.get(map_id)
            if cached is None or cached[0] < revision:
                self._cache[map_id] = (revision, graph)
                self._cache.move_to_end(map_id)
            while len(self._cache) > CACHED_MAPS:
                self._cache.popitem(last=False)

    def _quarantine(self, name: str, map_id: int, damaged: dict[int, str]) -> None:
        """Mark nodes whose content is damaged; a full disk shall not turn this into a failed read."""
        for node_id, problem in damaged.items():
            log.error("map %s, node %d quarantined: %s", name, node_id, problem)
        if not damaged:
            return
        try:
            with self._writing, self.database.write() as connection:
                mine = (nodes.c.map_id == map_id, nodes.c.node_id.in_(list(damaged)[: blobs.CHUNK]))
                connection.execute(update(nodes).where(*mine).values(quarantined=True))
        except MapError as error:
            log.error("map %s: quarantine not written: %s", name, error)


def _stored_form(
    operations: Sequence[Operation],
) -> tuple[tuple[Step, ...], dict[str, bytes], tuple[Operation, ...]]:
    """Steps for the graph, the blobs they name, and the operations to publish (without thumbnails)."""
    steps: list[Step] = []
    contents: dict[str, bytes] = {}
    published: list[Operation] = []
    for operation in operations:
        if not isinstance(operation, AddNode):
            steps.append(operation)
            published.append(operation)
            continue
        features: Features = operation.features.model_copy(update={"thumbnail": b""})
        picture, words = operation.features.thumbnail, blobs.pack_features(features)
        place = Place(
            node=operation.node,
            features=blobs.checksum(words),
            thumbnail=blobs.checksum(picture) if picture else "",
        )
        contents[place.features] = words
        if picture:
            contents[place.thumbnail] = picture
        steps.append(AddPlace(place=place))
        published.append(operation.model_copy(update={"features": features}))
    return tuple(steps), contents, tuple(published)


def _check_base(name: str, revision: int, base_revision: int | None) -> None:
    if base_revision is not None and base_revision != revision:
        raise ConflictError(
            f"map {name!r} is at revision {revision}, not {base_revision}; read it again and decide anew"
        )


def _place(graph: Graph, name: str, node_id: int) -> Place:
    place = graph.places.get(node_id)
    if place is None:
        raise MissingError(f"map {name!r}: node {node_id} does not exist")
    return place


def quarantined(connection: Connection, map_id: int) -> set[int]:
    """Nodes whose content is damaged."""
    query = select(nodes.c.node_id).where(nodes.c.map_id == map_id, nodes.c.quarantined)
    return set(connection.execute(query).scalars())
