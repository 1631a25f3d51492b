"""How old a command is, counted in the robot's own frames: no clock of another machine has a say."""

from collections import deque

MOST_AGE_S = 3.0
"""A frame becomes a command within this; the answer to an older one was held up: the robot is elsewhere."""


class CommandAge:
    """Remembers when the newest frames went out; times are monotonic seconds."""

    def __init__(self) -> None:
        self._sent: deque[tuple[int, float]] = deque()

    def sent(self, seq: int, now_s: float) -> None:
        """Note one frame."""
        self._sent.append((seq, now_s))

    def recent(self, seq: int, now_s: float) -> bool:
        """Whether frame `seq` went out lately. One that never went out is of a robot before a restart."""
        while len(self._sent) > 1 and now_s - self._sent[0][1] > MOST_AGE_S:
            self._sent.popleft()
        return bool(self._sent) and self._sent[0][0] <= seq <= self._sent[-1][0]
