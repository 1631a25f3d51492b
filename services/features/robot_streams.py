"""What belongs to one robot in a feature service that may serve several."""

from dataclasses import dataclass
from typing import Self

from services.features.frame_cache import FrameCache
from shared.bus import Bus, Inbox, Publisher, Requests
from shared.messages.features import Features
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.sensors import Frame
from shared.topics import FEATURES, FRAME, MATCH


@dataclass(frozen=True)
class RobotStreams:
    """Frames in, features out, questions about them, and the features that are kept for the questions."""

    frames: Inbox[Frame]
    features: Publisher[Features]
    matches: Requests[MatchRequest, MatchReply]
    kept: FrameCache

    @classmethod
    def open(cls, bus: Bus, robot: str, frames_kept: int) -> Self:
        """Declare the streams of `robot`; of its frames only the newest waits."""
        return cls(
            frames=bus.subscribe(FRAME, robot=robot),
            features=bus.publisher(FEATURES, robot=robot),
            matches=bus.requests(MATCH, robot=robot),
            kept=FrameCache(frames_kept),
        )
