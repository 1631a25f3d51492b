"""What nodes look like: features and thumbnails, checked on every read, damaged ones left out and named."""

import logging
from collections.abc import Callable, Iterable, Sequence
from typing import Literal, TypeVar

from sqlalchemy import Connection

from services.map_store.errors import CorruptError, InvalidError, MissingError
from services.map_store.storage import blobs, catalogue
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.database import Database
from services.map_store.storage.graph import Graph, StoredNode
from services.map_store.storage.graphs import Graphs
from shared.messages.maps import NodeFeatures, NodePicture

log = logging.getLogger(__name__)

Kind = Literal["features", "thumbnail"]
Told = TypeVar("Told", NodeFeatures, NodePicture)
MAX_ANSWER_BYTES = 400_000_000
"""Features in one answer; the 512 MB that `shared.topics.MAP` carries leave room for the rest of it."""


class Contents:
    """Reads the blobs of `database`."""

    def __init__(self, database: Database, graphs: Graphs) -> None:
        self._database, self._graphs = database, graphs
        self._seen_damaged: set[str] = set()

    def features(self, name: str, node_ids: Sequence[int]) -> tuple[MapRecord, tuple[NodeFeatures, ...]]:
        """The map's record and the features of `node_ids`, of all nodes when empty.

        A node whose features are damaged is logged and left out: the others stay of use.
        """

        def told(node_id: int, data: bytes) -> NodeFeatures:
            return NodeFeatures(node_id=node_id, features=blobs.unpack_features(data))

        return self._told(name, node_ids, "features", told)

    def pictures(self, name: str, node_ids: Sequence[int]) -> tuple[MapRecord, tuple[NodePicture, ...]]:
        """The same of their thumbnails."""
        return self._told(name, node_ids, "thumbnail", lambda n, data: NodePicture(node_id=n, picture=data))

    def _told(
        self, name: str, node_ids: Sequence[int], kind: Kind, told: Callable[[int, bytes], Told]
    ) -> tuple[MapRecord, tuple[Told, ...]]:
        answers: list[Told] = []
        with self._database.read() as connection:
            found = catalogue.find(connection, name)
            graph = self._graphs.get(connection, found)
            chosen = [node_of(graph, name, node_id) for node_id in (node_ids or sorted(graph.nodes))]
            size = blobs.sizes(connection, {_checksum(stored, kind) for stored in chosen})
            if size > MAX_ANSWER_BYTES:
                raise InvalidError(
                    f"map {name!r}: {size} bytes of {kind}, at most {MAX_ANSWER_BYTES} go into one answer; "
                    "ask for fewer nodes at a time"
                )
            for stored in chosen:
                checksum = _checksum(stored, kind)
                try:
                    data = blobs.get(connection, checksum) if checksum else b""
                    answers.append(told(stored.node_id, data))
                except CorruptError as error:
                    log.error("map %s: node %d is left out: %s", name, stored.node_id, error)
                    self._seen_damaged.add(checksum)
        return found, tuple(answers)

    def read(self, name: str, stored: StoredNode, kind: Kind) -> bytes:
        """Bytes of one blob of a node, b"" when it has no thumbnail; CorruptError names map and node."""
        sha256 = _checksum(stored, kind)
        if not sha256:
            return b""
        with self._database.read() as connection:
            try:
                return blobs.get(connection, sha256)
            except CorruptError as error:
                where = f"map {name!r}, node {stored.node_id}: {kind}"
                raise CorruptError(f"{where}: {error}; delete the node or import a backup") from None

    def damaged(self, connection: Connection, checksums: Iterable[str]) -> set[str]:
        """Those of these features that were damaged when somebody asked for them, and still are."""
        return set(blobs.unreadable(connection, self._seen_damaged.intersection(checksums)))


def _checksum(stored: StoredNode, kind: Kind) -> str:
    return stored.thumbnail if kind == "thumbnail" else stored.features


def node_of(graph: Graph, name: str, node_id: int) -> StoredNode:
    """One node; MissingError names map and node."""
    if node_id not in graph.nodes:
        raise MissingError(f"map {name!r}: node {node_id} does not exist")
    return graph.nodes[node_id]
