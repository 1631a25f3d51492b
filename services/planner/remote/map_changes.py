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
        """Hear of this map from now on, and once more of its last changes; to be called before it is read."""
        if name == self._name:
            return
        if self._inbox is not None:
            self._bus.unsubscribe(self._inbox)
        self._name, self._first = name, []
        self._inbox = self._bus.subscribe(MAP_DELTA, self._wake, map=name)

    def take_all(self) -> list[MapDelta]:
        """Those since the last call; of those before the last reset only what the map is called since."""
        taken, self._first = self._first, []
        if self._inbox is not None:
            taken += self._inbox.take_all()
        last = max((place for place, delta in enumerate(taken) if delta.reset), default=0)
        return [delta for delta in taken[:last] if delta.renamed_to] + taken[last:]

    def wait(self, timeout_s: float) -> list[MapDelta]:
        """Those since the last call; where there are none, the next that comes in time."""
        if (waiting := self.take_all()) or self._inbox is None:
            return waiting
        came = self._inbox.wait(timeout_s)
        return [] if came is None else [came, *self.take_all()]

    def put_back(self, deltas: list[MapDelta]) -> None:
        """Have them taken first at the next call."""
        self._first = deltas + self._first
