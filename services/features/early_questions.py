"""Questions about a frame that comes later: who asks may have the newest frame before this service has."""

import time
from collections.abc import Iterator

from services.features.frame_cache import FrameCache
from shared.bus import Request
from shared.messages.matching import MatchReply, MatchRequest

EARLY_S = 2.0
"""How long a question waits for its frame; chosen: twice what a loaded machine needs for a frame."""
MOST = 16
"""Questions that wait; chosen: as many as one gateway asks at once. One more is answered as things stand."""

Question = Request[MatchRequest, MatchReply]


class EarlyQuestions:
    """Keeps a question back until its frame was extracted, a newer one was, or `EARLY_S` have passed."""

    def __init__(self) -> None:
        self._waiting: list[tuple[float, Question]] = []

    def keep(self, question: Question, frames: FrameCache) -> bool:
        """Keep the question back if its frame is still to come; False if it can be dealt with now."""
        if not _is_early(question.message, frames) or len(self._waiting) >= MOST:
            return False
        self._waiting.append((time.monotonic() + EARLY_S, question))
        return True

    def due(self, frames: FrameCache) -> Iterator[Question]:
        """The questions that need not wait any longer, in the order they came."""
        now_s, waiting, self._waiting = time.monotonic(), self._waiting, []
        for until_s, question in waiting:
            if now_s < until_s and _is_early(question.message, frames):
                self._waiting.append((until_s, question))
            else:
                yield question


def _is_early(question: MatchRequest, frames: FrameCache) -> bool:
    return question.features is None and frames.is_ahead(question.seq)
