"""The mission's view of other services: matches from the feature service, the map from the map store."""

from collections.abc import Sequence

from services.planner.graph import MapGraph
from services.planner.ports import GOAL
from shared.bus import Bus
from shared.messages import MapReply, MapRequest, MatchRequest
from shared.messages.features import Features
from shared.messages.maps import Operation
from shared.messages.matching import NodeMatch
from shared.queries import RefusedError
from shared.topics import MAP, MATCH

AUTHOR = "planner"


class RemoteMap:
    """One map: a copy of its graph that follows the store's revisions."""

    def __init__(self, bus: Bus, name: str, timeout_s: float) -> None:
        self._bus, self.name, self._timeout_s = bus, name, timeout_s
        self.graph = MapGraph()
        self.revision = 0

    def load(self, *, create: bool) -> None:
        """Read the map, making it first when `create` and it is missing; RefusedError when it is missing."""
        try:
            reply = self._ask(MapRequest(action="read"))
        except RefusedError:
            if not create:
                raise
            self._ask(MapRequest(action="create", author=AUTHOR))
            reply = self._ask(MapRequest(action="read"))
        self.graph = MapGraph(reply.nodes, reply.edges)
        self.revision = reply.revision

    def commit(self, operations: Sequence[Operation]) -> None:
        """Write all or none; if somebody else wrote meanwhile, read again and retry once."""
        try:
            reply = self._transact(operations)
        except RefusedError:
            before = self.revision
            self.load(create=False)
            if self.revision == before:
                raise
            reply = self._transact(operations)
        self.graph.apply(operations)
        self.revision = reply.revision

    def features_of(self, node_id: int) -> Features:
        """What a node looks like."""
        return self._ask(MapRequest(action="read_features", node_ids=(node_id,))).features[0].features

    def _transact(self, operations: Sequence[Operation]) -> MapReply:
        return self._ask(
            MapRequest(
                action="transact", author=AUTHOR, base_revision=self.revision, operations=tuple(operations)
            )
        )

    def _ask(self, request: MapRequest) -> MapReply:
        return self._bus.ask(MAP, request, self._timeout_s, map=self.name)


class RemoteMatcher:
    """Asks the feature service about one frame, set before each step.

    Attributes:
        match_ms: time the service spent on matching for this frame, all answers together; verify_ms alike.
    """

    def __init__(self, bus: Bus, robot: str, maps: RemoteMap, timeout_s: float) -> None:
        self._bus, self._robot, self._maps, self._timeout_s = bus, robot, maps, timeout_s
        self.frame_seq = 0
        self.frame_stamp_ns = 0
        self.match_ms = self.verify_ms = 0.0

    def begin(self, frame_seq: int, frame_stamp_ns: int) -> None:
        """Ask about this frame from now on; what its answers cost is counted from zero."""
        self.frame_seq, self.frame_stamp_ns = frame_seq, frame_stamp_ns
        self.match_ms = self.verify_ms = 0.0

    def match(
        self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()
    ) -> dict[int, NodeMatch]:
        """Matches of the current frame by node id; the first target is GOAL."""
        return self._ask(
            MatchRequest(
                seq=self.frame_seq,
                stamp_ns=self.frame_stamp_ns,
                map=self._maps.name,
                map_revision=self._maps.revision,
                node_ids=tuple(n for n in node_ids if n != GOAL),
                best_k=best_k,
                targets=tuple(targets),
            )
        )

    def locate(self, features: Features, best_k: int) -> dict[int, NodeMatch]:
        """Matches of any picture with the most similar nodes."""
        return self._ask(
            MatchRequest(
                map=self._maps.name,
                map_revision=self._maps.revision,
                features=features,
                best_k=best_k,
                with_matches=False,
            )
        )

    def _ask(self, request: MatchRequest) -> dict[int, NodeMatch]:
        reply = self._bus.ask(MATCH, request, self._timeout_s, robot=self._robot)
        self.match_ms += reply.match_ms
        self.verify_ms += reply.verify_ms
        return {match.node_id: match for match in reply.results}
