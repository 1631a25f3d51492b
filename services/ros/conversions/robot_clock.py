"""The robot's clock against this machine's: nobody keeps the two together. Pure.

Of each topic the fastest message on its way says how far the clocks are apart (stamp minus arrival, at most).
A message that is further behind than that was held up; one that is ahead of it, or several that are behind by
the same, mean that the robot's clock jumped.
"""

from collections import deque
from dataclasses import dataclass
from typing import Literal

JUMP_S = 0.5
"""More than this off is no ordinary delay; chosen: a command's life twice over."""
AGREED = 4
"""Messages in a row that are behind by the same are a jump, fewer were held up; chosen."""
AGREED_S = 0.2
"""What "the same" means; chosen: the jitter of a radio link."""
LEAK_SPS = 1.0e-3
"""The estimate gives way by so much a second: clocks drift by 0.1 s a day, and a fast message long ago is no
measure of those of now; chosen."""

Verdict = Literal["good", "late", "jumped"]


@dataclass(frozen=True)
class Judged:
    """What a stamp is worth.

    Attributes:
        off_s: behind (negative) or ahead of what was expected.
    """

    verdict: Verdict
    off_s: float = 0.0


class RobotClock:
    """One topic's stamps."""

    def __init__(self) -> None:
        self.offset_s: float | None = None
        self._heard_s = 0.0
        self._behind: deque[float] = deque(maxlen=AGREED)

    def judge(self, stamp_s: float, came_s: float) -> Judged:
        """Take a stamp of the robot's clock that came at `came_s` of ours, seconds each."""
        offset_s = stamp_s - came_s
        if self.offset_s is None:
            self._restart(offset_s, came_s)
            return Judged("good")
        expected_s = self.offset_s - LEAK_SPS * max(0.0, came_s - self._heard_s)
        off_s = offset_s - expected_s
        if off_s > JUMP_S:
            self._restart(offset_s, came_s)
            return Judged("jumped", off_s)
        if off_s < -JUMP_S:
            self._behind.append(off_s)
            if len(self._behind) == AGREED and max(self._behind) - min(self._behind) < AGREED_S:
                self._restart(offset_s, came_s)
                return Judged("jumped", off_s)
            return Judged("late", off_s)
        self._behind.clear()
        self.offset_s, self._heard_s = max(expected_s, offset_s), came_s
        return Judged("good", off_s)

    def _restart(self, offset_s: float, came_s: float) -> None:
        self.offset_s, self._heard_s = offset_s, came_s
        self._behind.clear()
