"""The maps in which tasks begin, read when they are asked for and again when they have changed."""

from shared.bus import Bus
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.keep_clear import current_limits
from shared.mapgraph.routing import metres_to
from shared.messages.maps import MapRequest
from shared.queries import RefusedError
from shared.topics import MAP_DELTA, MAP_READ
from shared.wall_clock import WallClock


class Maps:
    """Copies of maps.

    Args:
        period_s: one that changes is read anew at most so often: it is large, and ways hardly change.
        timeout_s: for an answer of the map store.
    """

    def __init__(self, bus: Bus, period_s: float, timeout_s: float) -> None:
        self._bus, self._period_s, self._timeout_s = bus, period_s, timeout_s
        self._deltas = bus.subscribe(MAP_DELTA, map="*")
        self._graphs: dict[str, MapGraph] = {}
        self._read_s: dict[str, float] = {}
        self._changed: set[str] = set()

    def follow(self) -> None:
        """Note what changed since the last call."""
        self._changed.update(delta.map for delta in self._deltas.take_all())

    def graph(self, name: str, now_s: float) -> MapGraph:
        """A map as it is, or was `period_s` ago; without nodes where it is missing. `now_s` is monotonic.

        Raises:
            QueryError, WireError: the map store does not answer as it should.
        """
        old = now_s - self._read_s.get(name, float("-inf")) >= self._period_s
        if name not in self._graphs or (name in self._changed and old):
            self._changed.discard(name)
            self._graphs[name], self._read_s[name] = self._read(name), now_s
        return self._graphs[name]

    def metres_to(self, name: str, node_id: int, now_s: float) -> dict[int, float]:
        """Metres from every node of a map to one of them, as its rules allow to drive now."""
        graph = self.graph(name, now_s)
        return metres_to(graph, node_id, current_limits(graph, WallClock.now()))

    def _read(self, name: str) -> MapGraph:
        try:
            reply = self._bus.ask(MAP_READ, MapRequest(action="read"), self._timeout_s, map=name)
        except RefusedError:  # missing, or damaged: its tasks are given away all the same
            return MapGraph()
        return MapGraph(reply.nodes, reply.edges, reply.places, reply.rules, reply.routes, reply.signs)
