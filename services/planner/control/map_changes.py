"""What others write to the map of the mission."""

import threading

from shared.bus import Bus
from shared.inbox import Inbox
from shared.messages.maps import MapDelta
from shared.topics import MAP_DELTA


class MapChanges:
    """Hears of one map at a time: those that other robots explore say several things a second each."""

    def __init__(self, bus: Bus) -> None:
        self._bus, self._wake = bus, threading.Event()
        self._name = ""
        self._inbox: Inbox[MapDelta] | None = None
        self._first: list[MapDelta] = []

    def follow(self, name: str) -> None:
        """Hear of this map from now on; to be called before the map is read, as what came before is not told.

        What was said of a map of that name in the past may be of another one, which has been renamed since.
        """
        if name == self._name:
            return
        if self._inbox is not None:
            self._bus.unsubscribe(self._inbox)
        self._name, self._first = name, []
        self._inbox = self._bus.subscribe(MAP_DELTA, self._wake, past=False, map=name)

    def take_all(self) -> list[MapDelta]:
        """Those since the last call."""
        first, self._first = self._first, []
        return first + ([] if self._inbox is None else self._inbox.take_all())

    def wait(self, timeout_s: float) -> list[MapDelta]:
        """Those since the last call; where there are none, the next that comes in time."""
        if (waiting := self.take_all()) or self._inbox is None:
            return waiting
        came = self._inbox.wait(timeout_s)
        return [] if came is None else [came, *self.take_all()]

    def put_back(self, deltas: list[MapDelta]) -> None:
        """Have them taken first at the next call."""
        self._first = deltas + self._first
