"""How old a frame is, counted on this process's own clock: no other machine's clock has a say. Pure."""

from bisect import bisect_left

MOST_FRAMES = 1_000


class FrameAges:
    """Remembers when each frame number was first heard of; times are monotonic seconds."""

    def __init__(self) -> None:
        self._seqs: list[int] = []
        self._heard_s: list[float] = []

    def heard(self, seq: int, now_s: float) -> None:
        """Note that the robot is at frame `seq`; a lower number than before is a robot that restarted."""
        if self._seqs and seq < self._seqs[-1]:
            self._seqs.clear()
            self._heard_s.clear()
        if not self._seqs or seq > self._seqs[-1]:
            self._seqs.append(seq)
            self._heard_s.append(now_s)
        if len(self._seqs) > MOST_FRAMES:
            del self._seqs[: MOST_FRAMES // 2], self._heard_s[: MOST_FRAMES // 2]

    def age_s(self, seq: int, now_s: float) -> float:
        """How long ago frame `seq` was taken, at least; 0 for one that was not heard of yet."""
        place = bisect_left(self._seqs, seq)
        return now_s - self._heard_s[place] if place < len(self._seqs) else 0.0
