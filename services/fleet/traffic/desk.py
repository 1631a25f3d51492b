"""Answers robots that ask for the right of way, in a thread of its own: they wait for it with every step."""

import logging
import threading
import time

from services.fleet.maps import Maps
from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.rights import LEASE_S, Claim, Grant, Rights
from shared.bus import Bus
from shared.mapgraph.graph import MapGraph
from shared.messages.traffic import WayReply, WayRequest
from shared.queries import QueryError, Request
from shared.topics import WAY
from shared.wire import WireError

log = logging.getLogger(__name__)

PERIOD_S = 0.5
"""Longest sleep of the thread when nobody asks; chosen."""
LISTENING = "the fleet service has just begun, and listens who is where"


class Desk:
    """All rights of way. Only one process grants them: of several the one whose token comes first.

    Args:
        bus: to robots and map store.
        period_s: a map that changes is read anew at most so often.
        timeout_s: for an answer of the map store.
    """

    def __init__(self, bus: Bus, period_s: float, timeout_s: float) -> None:
        self._bus = bus
        self._wake = threading.Event()
        self._requests = bus.requests(WAY, wake=self._wake, robot="*")
        self._maps = Maps(bus, period_s, timeout_s)
        self._near: dict[str, tuple[MapGraph, Nearness]] = {}
        self._rights, self._lock = Rights(), threading.Lock()
        self._own, self._all = "", frozenset[str]()
        self._began_s: float | None = None

    def announce(self) -> None:
        """Tell robots that there is somebody to ask, and hear of others who say so."""
        self._own = self._bus.announce("fleet")
        self._bus.watch_alive(self._note, "fleet")

    def serve(self, stop: threading.Event) -> None:
        """Answer until `stop`."""
        while not stop.is_set():
            self._wake.wait(PERIOD_S)
            self._wake.clear()
            self.step(time.monotonic())

    def step(self, now_s: float) -> None:
        """Answer who asked; `now_s` is monotonic."""
        self._maps.follow()
        if not self._leads():
            self._began_s = None
        elif self._began_s is None:
            self._began_s = now_s
        while (request := self._requests.take()) is not None:
            if self._began_s is None:
                request.leave()
            else:
                self._answer(request, now_s, listening=now_s - self._began_s < LEASE_S)

    def to_send(self, now_s: float) -> list[Claim]:
        """Robots that stand in the way of others with nothing to do, each with the way to its refuge."""
        with self._lock:
            return self._rights.standing(now_s)

    def _leads(self) -> bool:
        return self._own == min(self._all, default=self._own)

    def _answer(self, request: Request[WayRequest, WayReply], now_s: float, *, listening: bool) -> None:
        asked = request.message
        if asked.robot != request.name:
            request.refuse(f"robot {request.name!r} expected, got {asked.robot!r}", "invalid")
            return
        try:
            near = self._nearness(asked.map, now_s)
        except (QueryError, WireError) as error:
            request.refuse(f"map {asked.map}: {error}", "unavailable")
            return
        claim = Claim(asked.robot, asked.map, asked.at, asked.ahead, busy=asked.busy)
        with self._lock:
            grant = self._rights.note(claim, now_s) if listening else self._rights.ask(claim, near, now_s)
        if listening:
            grant = Grant(grant.free, LISTENING)
        request.reply(WayReply(free=grant.free, why=grant.why[:200], room=grant.room))

    def _nearness(self, name: str, now_s: float) -> Nearness:
        """What is near in a map as it is now.

        Raises:
            QueryError, WireError: the map store does not answer as it should.
        """
        graph = self._maps.graph(name, now_s)
        known = self._near.get(name)
        if known is None or known[0] is not graph:
            self._near[name] = known = graph, Nearness(graph)
        return known[1]

    def _note(self, _service: str, instance: str, alive: bool) -> None:
        """On Zenoh's thread: a fleet service came or went."""
        self._all = self._all | {instance} if alive else self._all - {instance}
