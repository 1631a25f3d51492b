"""One map as the map store has it: read once, then kept up by its deltas."""

import math

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.operations import GraphError
from shared.messages.maps import MapDelta, MapReply


class FollowedMap:
    """A map and what became of it; `stale` until it is read, and again after a gap.

    Attributes:
        graph: as of `revision`; of before the gap while it is stale.
        changed: since it was last drawn.
        asked_s: when it was last asked for, seconds of a clock that never goes back.
    """

    def __init__(self) -> None:
        self.graph, self.revision = MapGraph(), -1
        self.stale, self.changed = True, True
        self.asked_s = -math.inf

    def load(self, reply: MapReply) -> None:
        """Take over what was read."""
        self.graph = MapGraph(reply.nodes, reply.edges, reply.places, reply.rules, reply.routes)
        self.revision, self.stale, self.changed = reply.revision, False, True

    def apply(self, delta: MapDelta) -> None:
        """Take over a change, in order; one that is known already is passed over."""
        if self.stale or (delta.revision <= self.revision and not delta.reset):
            return
        if delta.reset or delta.revision != self.revision + 1:
            self.stale = True
            return
        try:
            self.graph.apply(delta.operations)
        except GraphError:
            self.stale = True
            return
        self.revision, self.changed = delta.revision, True
