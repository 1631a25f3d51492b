"""Maps as scenes, in a thread of its own: reading one waits for the map store, drawing one computes."""

import threading
import time
from functools import partial

from services.recorder.foxglove.forms import Form, schema_of
from services.recorder.foxglove.live.followed_map import FollowedMap
from services.recorder.foxglove.live.map_scene import map_scene
from services.recorder.foxglove.live.server import Shown
from shared.bus import Bus
from shared.messages.maps import MapRequest
from shared.queries import QueryError, RefusedError
from shared.topics import MAP_DELTA, MAP_READ, STATUS
from shared.wire import WireError

PERIOD_S = 1.0
"""Between two drawings; chosen: an exploring robot adds a node every few seconds."""
RETRY_S = 2.0
"""Between two questions for a map that is not there, or whose store is away; chosen."""
READ_TIMEOUT_S = 10.0
"""A map of 20,000 nodes is read in 2 s."""
MAX_MAPS = 16
"""Followed at once; chosen: a peer that invents names takes no more."""


class MapScenes:
    """Follows each map that a mission is in or that changes, and shows it to those who look."""

    def __init__(self, bus: Bus, shown: Shown) -> None:
        self._bus, self._shown = bus, shown
        self._wake, self._stop = threading.Event(), threading.Event()
        self._statuses = bus.subscribe(STATUS, wake=self._wake, robot="*")
        self._deltas = bus.subscribe(MAP_DELTA, wake=self._wake, map="*")
        self._maps: dict[str, FollowedMap] = {}
        self._thread = threading.Thread(target=self._run, name="maps", daemon=True)

    def __enter__(self) -> "MapScenes":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._wake.set()
        self._thread.join(READ_TIMEOUT_S)

    def check(self) -> None:
        """Raise RuntimeError where the thread has died: the process ends with it, to be started anew."""
        if not self._thread.is_alive():
            raise RuntimeError("the thread that draws maps has died")

    def show_again(self, begun: set[str]) -> None:
        """Draw the maps whose channels somebody has begun to listen to."""
        for name in [name for name in self._maps if _channel(name) in begun]:
            self._maps[name].changed = True
        self._wake.set()

    def _run(self) -> None:
        while not self._stop.is_set():
            self._wake.wait(RETRY_S)
            self._wake.clear()
            self._hear()
            for name, followed in list(self._maps.items()):
                if followed.stale:
                    self._read(name, followed)
                if followed.changed and not followed.stale:
                    self._draw(name, followed)
            self._stop.wait(PERIOD_S)

    def _hear(self) -> None:
        for status in self._statuses.take_all():
            self._follow(status.map)
        for delta in self._deltas.take_all():
            self._follow(delta.map)
            if delta.map in self._maps:
                self._maps[delta.map].apply(delta)

    def _follow(self, name: str) -> None:
        if name not in self._maps and len(self._maps) >= MAX_MAPS:
            absent = [one for one, followed in self._maps.items() if followed.revision < 0]
            for one in absent[:1]:
                del self._maps[one]
        if len(self._maps) < MAX_MAPS:
            self._maps.setdefault(name, FollowedMap())

    def _read(self, name: str, followed: FollowedMap) -> None:
        """Ask the map store; where it is away or busy the last picture stays, and it is asked again."""
        now_s = time.monotonic()
        if now_s - followed.asked_s < RETRY_S:
            return
        followed.asked_s = now_s
        try:
            followed.load(self._bus.ask(MAP_READ, MapRequest(action="read"), READ_TIMEOUT_S, map=name))
        except RefusedError:  # no such map
            if followed.revision >= 0:  # any more: whoever looks sees it empty
                self._maps[name] = empty = FollowedMap()
                self._draw(name, empty)
        except (QueryError, WireError) as error:
            self._bus.counters.count("unread map", f"{name}: {error}")

    def _draw(self, name: str, followed: FollowedMap) -> None:
        channel = _channel(name)
        if self._shown.known(channel) and not self._shown.watched(channel):
            return  # whoever begins to look has it drawn
        followed.changed = False
        try:
            scene = map_scene(name, followed.graph)
        except (ValueError, ArithmeticError) as error:  # numpy's linear algebra raises the first
            self._bus.counters.count("undrawable", f"map {name}: {error}")
            return
        self._shown.put(Form(channel, partial(schema_of, scene), scene.encode()), time.time_ns())


def _channel(name: str) -> str:
    return f"topnav/maps/{name}/graph"
