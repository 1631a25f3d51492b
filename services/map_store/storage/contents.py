"""What nodes look like: features and thumbnails, checked on every read, damaged ones put in quarantine."""

import logging
from collections.abc import Sequence
from typing import Literal

from sqlalchemy import and_

from services.map_store.errors import CorruptError, InvalidError, MapError, MissingError
from services.map_store.integrity import quarantine
from services.map_store.storage import blobs, catalogue
from services.map_store.storage.database import Database
from services.map_store.storage.graph import Graph, Place
from services.map_store.storage.graphs import Graphs
from services.map_store.storage.tables import nodes
from shared.messages.maps import NodeFeatures

log = logging.getLogger(__name__)

Kind = Literal["features", "thumbnail"]
MAX_ANSWER_BYTES = 400_000_000
"""Features in one answer; the bus carries 512 MB."""


class Contents:
    """Reads the blobs of `database`."""

    def __init__(self, database: Database, graphs: Graphs) -> None:
        self._database, self._graphs = database, graphs

    def features(self, name: str, node_ids: Sequence[int]) -> tuple[int, tuple[NodeFeatures, ...]]:
        """The revision and the features of `node_ids`, of all nodes when empty.

        A node whose features are damaged is left out and put in quarantine: the others stay of use.
        """
        answers: list[NodeFeatures] = []
        damaged: dict[int, str] = {}
        with self._database.read() as connection:
            found = catalogue.find(connection, name)
            graph = self._graphs.get(connection, found)
            places = [place_of(graph, name, node_id) for node_id in (node_ids or sorted(graph.places))]
            size = blobs.sizes(connection, {place.features for place in places})
            if size > MAX_ANSWER_BYTES:
                raise InvalidError(
                    f"map {name!r}: {size} bytes of features, at most {MAX_ANSWER_BYTES} go into one answer; "
                    "ask for fewer nodes at a time"
                )
            for place in places:
                node_id = place.node.node_id
                try:
                    features = blobs.unpack_features(blobs.get(connection, place.features))
                    answers.append(NodeFeatures(node_id=node_id, features=features))
                except CorruptError as error:
                    damaged[node_id] = str(error)
        self._quarantine(name, found.map_id, damaged)
        return found.revision, tuple(answers)

    def read(self, name: str, place: Place, kind: Kind) -> bytes:
        """Bytes of one blob of a node, b"" when it has no thumbnail; CorruptError names map and node."""
        sha256 = place.thumbnail if kind == "thumbnail" else place.features
        if not sha256:
            return b""
        with self._database.read() as connection:
            try:
                return blobs.get(connection, sha256)
            except CorruptError as error:
                where = f"map {name!r}, node {place.node.node_id}: {kind}"
                raise CorruptError(f"{where}: {error}; delete the node or import a backup") from None

    def _quarantine(self, name: str, map_id: int, damaged: dict[int, str]) -> None:
        """Mark damaged nodes; a full disk shall not turn this into a failed read."""
        for node_id, reason in damaged.items():
            log.error("map %s: node %d in quarantine: %s", name, node_id, reason)
        if not damaged:
            return
        try:
            with self._database.write() as connection:
                chosen = nodes.c.node_id.in_(list(damaged)[: blobs.CHUNK])
                quarantine.mark(connection, and_(nodes.c.map_id == map_id, chosen), quarantined=True)
        except MapError as error:
            log.error("map %s: quarantine not written: %s", name, error)


def place_of(graph: Graph, name: str, node_id: int) -> Place:
    """One node; MissingError names map and node."""
    place = graph.places.get(node_id)
    if place is None:
        raise MissingError(f"map {name!r}: node {node_id} does not exist")
    return place
