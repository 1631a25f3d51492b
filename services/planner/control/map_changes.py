"""What others write to the map of the mission."""

from shared.bus import Bus
from shared.inbox import Inbox
from shared.messages.maps import MapDelta
from shared.topics import MAP_DELTA


class MapChanges:
    """Hears of one map at a time: those that other robots explore say several things a second each."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._name = ""
        self._inbox: Inbox[MapDelta] | None = None

    def follow(self, name: str) -> None:
        """Hear of this map from now on; to be called before the map is read, as what came before is not told.

        What was said of a map of that name in the past may be of another one, which has been renamed since.
        """
        if name == self._name:
            return
        if self._inbox is not None:
            self._bus.unsubscribe(self._inbox)
        self._name, self._inbox = name, self._bus.subscribe(MAP_DELTA, past=False, map=name)

    def take_all(self) -> list[MapDelta]:
        """Those since the last call."""
        return [] if self._inbox is None else self._inbox.take_all()
