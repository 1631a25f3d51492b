"""Merges of one map store: one at a time, and how the last ones ended."""

import threading

from services.map_store.merging.merge import Matcher, Merge, ReadMap
from services.map_store.store import MapStore

KEPT = 32
"""Maps whose last merge is remembered: as many as have their graphs in memory."""

STOP_S = 2.0
"""For a merge that is being written, of the 5 s in which a process has to stop (`docker-compose.yml`)."""


class Merges:
    """Starts merges in the background. Safe from any thread."""

    def __init__(self, store: MapStore, match: Matcher) -> None:
        self._store, self._match = store, match
        self._lock = threading.Lock()
        self._last: dict[str, Merge] = {}
        self._running: tuple[Merge, threading.Thread] | None = None

    @property
    def running(self) -> Merge | None:
        """The merge that has not ended."""
        return self._running[0] if self._running and self._running[0].progress.running else None

    def start(self, base: ReadMap, other: ReadMap, author: str) -> Merge | None:
        """Begin to add `other` to `base`; `author` stands in the history. None while another is running."""
        with self._lock:
            if self.running is not None:
                return None
            merge = Merge(self._store, self._match, base, other, author)
            self._last.pop(base.name, None)
            self._last[base.name] = merge
            while len(self._last) > KEPT:
                del self._last[next(iter(self._last))]
            thread = threading.Thread(target=merge.run, name="merge", daemon=True)
            try:
                thread.start()
                self._running = merge, thread
            except RuntimeError as error:  # no memory or no thread left: the next merge may find some
                reason = f"the merge got no thread ({error}): nothing was written; try again later"
                merge.progress.end("failed", reason)
        return merge

    def last(self, map_name: str) -> Merge | None:
        """The running or last merge into a map."""
        return self._last.get(map_name)

    def close(self) -> None:
        """End what is running; one that is being written gets a moment."""
        if self._running is not None:
            merge, thread = self._running
            merge.progress.cancel()
            thread.join(STOP_S if merge.progress.running else 0.0)
