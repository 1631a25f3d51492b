"""What belongs to one robot in a feature service that may serve several."""

from dataclasses import dataclass
from typing import Self

from services.features.early_questions import EarlyQuestions
from services.features.frame_cache import FrameCache
from services.features.map_features.map_cache import CachedMap
from shared.bus import Bus, Inbox, Publisher, Requests
from shared.messages.features import Features
from shared.messages.inspections import CompareReply, CompareRequest
from shared.messages.matching import MatchReply, MatchRequest, NodeMatch
from shared.messages.sensors import Frame
from shared.topics import COMPARE, FEATURES, FRAME, MATCH


class Answered:
    """Matches found for the frame last asked about: who makes a node asks about its surroundings twice."""

    def __init__(self) -> None:
        self._frame: Features | None = None
        self._map: CachedMap | None = None
        self._about: tuple[int, bool] = (0, False)
        self._matches: dict[int, NodeMatch] = {}

    def of(self, frame: Features, known: CachedMap, with_matches: bool) -> dict[int, NodeMatch]:
        """Matches by node id, to be added to; none where the frame, the map or what is wanted is another."""
        about = (known.revision, with_matches)
        if frame is not self._frame or known is not self._map or about != self._about:
            self._frame, self._map, self._about, self._matches = frame, known, about, {}
        return self._matches


@dataclass(frozen=True)
class RobotStreams:
    """Frames in, features out, questions about them, and what is kept for the questions."""

    frames: Inbox[Frame]
    features: Publisher[Features]
    matches: Requests[MatchRequest, MatchReply]
    comparisons: Requests[CompareRequest, CompareReply]
    early: EarlyQuestions
    kept: FrameCache
    answered: Answered

    @classmethod
    def open(cls, bus: Bus, robot: str, frames_kept: int) -> Self:
        """Declare the streams of `robot`; of its frames only the newest waits."""
        return cls(
            frames=bus.subscribe(FRAME, robot=robot),
            features=bus.publisher(FEATURES, robot=robot),
            matches=bus.requests(MATCH, robot=robot),
            comparisons=bus.requests(COMPARE, robot=robot),
            early=EarlyQuestions(),
            kept=FrameCache(frames_kept),
            answered=Answered(),
        )
