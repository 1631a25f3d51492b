"""Keeps the map cache true: reads a map at first use, follows its deltas, says what it could not get."""

import logging
import time
from collections.abc import Sequence

from services.features.map_features.map_cache import CachedMap, MapCache
from services.features.matching.requests import RequestError
from shared.bus import Bus
from shared.messages.maps import MapReply, MapRequest
from shared.queries import AbsentError, RefusedError, TimedOutError
from shared.topics import MAP_DELTA, MAP_READ
from shared.wire import WireError

log = logging.getLogger(__name__)

DELTA_WAIT_S = 0.2
"""How long a delta may still be under way; chosen: it takes milliseconds, to read the map anew seconds."""
PIECE = 250
"""Nodes per question: 10 to 20 MB, so that neither side holds a large map twice."""
READ_TRIES = 3
"""Readings of a map that changes meanwhile; chosen: nodes are seldom removed."""


class MapReader:
    """The maps this service has been asked about."""

    def __init__(self, bus: Bus, cache: MapCache, timeout_s: float) -> None:
        self._bus, self._timeout_s = bus, timeout_s
        self._deltas = bus.subscribe(MAP_DELTA, map="*")
        self._cache = cache

    def follow(self) -> None:
        """Apply all deltas that have arrived."""
        for delta in self._deltas.take_all():
            self._cache.apply(delta)

    def read(self, name: str, node_ids: tuple[int, ...], revision: int) -> CachedMap:
        """The map as of `revision` or later, with all of `node_ids`.

        A planner may ask about what it has just written before the delta gets here: a short wait, then
        the store is asked.

        Raises:
            RequestError: the store does not know the map, or does not answer.
        """
        self.follow()
        kept = self._cache.get(name)
        if kept is not None and kept.revision < revision:
            kept = self._await(name, revision)
        if kept is not None and all(node_id in kept.nodes for node_id in node_ids):
            return kept
        return self._read_whole(name)

    def pictures(self, name: str, node_ids: Sequence[int]) -> dict[int, bytes]:
        """Pictures of nodes; b"" of those that have none, or that were deleted meanwhile.

        Raises:
            RequestError: the store does not answer.
        """
        found = dict.fromkeys(node_ids, b"")
        try:
            reply = self._ask(name, MapRequest(action="read_pictures", node_ids=tuple(node_ids)))
        except RefusedError as error:
            log.info("map %r gives no pictures of nodes %s: %s", name, list(node_ids), error)
            return found
        return found | {each.node_id: each.picture for each in reply.pictures}

    def _await(self, name: str, revision: int) -> CachedMap | None:
        """The kept map once deltas have brought it to `revision`; None if they do not come or leave a gap."""
        deadline_s = time.monotonic() + DELTA_WAIT_S
        kept = self._cache.get(name)
        while kept is not None and kept.revision < revision:
            delta = self._deltas.wait(deadline_s - time.monotonic())
            if delta is None:
                return None
            self._cache.apply(delta)
            kept = self._cache.get(name)
        return kept

    def _read_whole(self, name: str) -> CachedMap:
        """Take over a map piece by piece; a node that goes meanwhile means: once more."""
        for _ in range(READ_TRIES - 1):
            try:
                return self._read_once(name)
            except RefusedError as error:
                log.info("map %r changed while it was read: %s", name, error)
        try:
            return self._read_once(name)
        except RefusedError as error:
            raise RequestError(f"map {name!r} keeps changing while it is read: {error}") from error

    def _read_once(self, name: str) -> CachedMap:
        self._cache.drop(name)
        try:
            graph = self._ask(name, MapRequest(action="read"))
        except RefusedError as error:
            raise RequestError(f"map {name!r} is not known to the map store: {error}") from error
        ids = [node.node_id for node in graph.nodes]
        pieces = (ids[start : start + PIECE] for start in range(0, len(ids), PIECE))
        features = (
            part
            for piece in pieces
            for part in self._ask(name, MapRequest(action="read_features", node_ids=tuple(piece))).features
        )
        loaded = self._cache.load(name, graph.revision, features)
        self.follow()
        return self._cache.get(name) or loaded

    def _ask(self, name: str, request: MapRequest) -> MapReply:
        try:
            return self._bus.ask(MAP_READ, request, self._timeout_s, map=name)
        except AbsentError as error:
            raise RequestError(f"map {name!r} cannot be read: the map store is not up") from error
        except (TimedOutError, WireError) as error:
            raise RequestError(f"map {name!r} cannot be read: {error}") from error
