"""Graphs in memory: the newest revision of the maps in use, so that a write does not read the whole map."""

import threading
from collections import OrderedDict

from sqlalchemy import Connection

from services.map_store.errors import CorruptError
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import Graph
from services.map_store.storage.rows import read_graph

CACHED_ELEMENTS = 40_000
"""Nodes and edges of all maps together; 20,000 take 73 MB (tracemalloc). A hundred robots that each map a
flat have 15,000, and a map that is not kept is read anew for each write."""


class Graphs:
    """A cache by map and revision; a revision that another process wrote is simply read again."""

    def __init__(self) -> None:
        self._graphs: OrderedDict[int, tuple[int, Graph]] = OrderedDict()
        self._elements = 0
        self._lock = threading.Lock()

    def get(self, connection: Connection, found: MapRecord) -> Graph:
        """The graph of the map that `catalogue.find` found, as this transaction sees it."""
        with self._lock:
            revision, graph = self._graphs.get(found.map_id, (-1, Graph()))
            if revision >= 0:
                self._graphs.move_to_end(found.map_id)
        if revision != found.revision:
            try:
                graph = read_graph(connection, found)
            except CorruptError as error:
                advice = f"'topnav map repair {found.name}' mends what can be mended"
                raise CorruptError(f"map {found.name!r}: {error}; {advice}") from None
            self.remember(found.map_id, found.revision, graph)
        return graph

    def forget(self, map_id: int) -> None:
        """Read the map again when it is asked for."""
        with self._lock:
            self._drop(map_id)

    def remember(self, map_id: int, revision: int, graph: Graph) -> None:
        """Keep `graph` unless a newer revision is kept already."""
        with self._lock:
            if self._graphs.get(map_id, (-1, graph))[0] >= revision:
                return
            self._drop(map_id)
            self._graphs[map_id] = (revision, graph)
            self._elements += _size(graph)
            while self._elements > CACHED_ELEMENTS and len(self._graphs) > 1:
                self._drop(next(iter(self._graphs)))

    def _drop(self, map_id: int) -> None:
        if (kept := self._graphs.pop(map_id, None)) is not None:
            self._elements -= _size(kept[1])


def _size(graph: Graph) -> int:
    return 1 + len(graph.nodes) + len(graph.edges)
