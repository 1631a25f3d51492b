"""The mission's matches: answers of the feature service about one frame after the other."""

from collections.abc import Callable, Sequence
from functools import partial

from services.planner.ports import Matches
from services.planner.remote.remote_map import RemoteMap
from shared.bus import Bus
from shared.mapgraph.routing import GOAL
from shared.messages.features import Features
from shared.messages.matching import MatchRequest
from shared.topics import MATCH

PHOTO_S = 30.0
"""At least so long an answer about a photo is waited for; chosen: ten times what sixty nodes take."""


class RemoteMatcher:
    """Asks the feature service about one frame, set before each step.

    Args:
        meanwhile: what else there is to do now and then while an answer is waited for.

    Attributes:
        ask_features: as `Bus.ask`, with what is to be done meanwhile.
        match_ms: time the service spent on matching for this frame, all answers together; verify_ms alike.
    """

    def __init__(
        self,
        bus: Bus,
        robot: str,
        maps: RemoteMap,
        timeout_s: float,
        meanwhile: Callable[[], None] | None = None,
    ) -> None:
        self.robot, self._maps, self._timeout_s = robot, maps, timeout_s
        self.ask_features = bus.ask if meanwhile is None else partial(bus.ask_while, meanwhile)
        self.frame_seq = 0
        self.frame_stamp_ns = 0
        self.match_ms = self.verify_ms = 0.0

    def begin(self, frame_seq: int, frame_stamp_ns: int) -> None:
        """Ask about this frame from now on; what its answers cost is counted from zero."""
        self.frame_seq, self.frame_stamp_ns = frame_seq, frame_stamp_ns
        self.match_ms = self.verify_ms = 0.0

    def match(self, node_ids: Sequence[int], best_k: int = 0, targets: Sequence[Features] = ()) -> Matches:
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

    def locate(
        self, features: Features, best_k: int, node_ids: Sequence[int] = (), *, with_differences: bool = False
    ) -> Matches:
        """Matches of any picture with given nodes, and with the most similar ones."""
        of_photo = features.photo is not None
        request = MatchRequest(
            map=self._maps.name,
            map_revision=self._maps.revision,
            features=features,
            node_ids=tuple(node_ids),
            best_k=best_k,
            with_matches=of_photo,
            with_differences=with_differences,
        )
        return self._ask(request, PHOTO_S if of_photo else 0.0)

    def _ask(self, request: MatchRequest, least_s: float = 0.0) -> Matches:
        timeout_s = max(self._timeout_s, least_s)
        reply = self.ask_features(MATCH, request, timeout_s, robot=self.robot)
        self.match_ms += reply.match_ms
        self.verify_ms += reply.verify_ms
        known = self._maps.graph.nodes  # the service may know of nodes of another robot before we do
        return {m.node_id: m for m in reply.results if m.node_id in known or m.node_id == GOAL}
