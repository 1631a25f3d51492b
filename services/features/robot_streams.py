"""What belongs to one robot in a feature service that may serve several."""

from dataclasses import dataclass
from typing import Self

import numpy as np

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
    """Matches found for the frame last asked about: who makes a node asks about its surroundings twice.

    And who had to wait too long for the places of a picture asks for them again.
    """

    def __init__(self) -> None:
        self._frame: Features | None = None
        self._map: CachedMap | None = None
        self._about: tuple[int, bool] = (0, False)
        self._matches: dict[int, NodeMatch] = {}

    def of(self, frame: Features, known: CachedMap, with_matches: bool) -> dict[int, NodeMatch]:
        """Matches by node id, to be added to; none where the frame, the map or what is wanted is another."""
        about = (known.revision, with_matches)
        same = self._frame is not None and shows_the_same(frame, self._frame)
        if not same or known is not self._map or about != self._about:
            self._frame, self._map, self._about, self._matches = frame, known, about, {}
        return self._matches


def shows_the_same(one: Features, other: Features) -> bool:
    """Whether two messages bear the features of one picture: each of a question is decoded anew."""
    return one is other or (
        (one.seq, one.pipeline, one.photo) == (other.seq, other.pipeline, other.photo)
        and np.array_equal(one.lonlat_rad, other.lonlat_rad)
        and np.array_equal(one.descriptors, other.descriptors)
    )


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
