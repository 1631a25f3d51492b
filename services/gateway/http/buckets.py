"""Token buckets by key: so many at once, then so many a second. Pure: the caller brings the clock."""

from collections import OrderedDict

MOST_KEYS = 4096
"""Clients remembered; the one heard of longest ago is forgotten, which at worst gives it a full bucket."""


class Buckets:
    """One bucket for each key, full at first.

    Args:
        rate_per_s: how fast a bucket fills.
        burst: how much it holds.
        most_keys: how many are remembered.
    """

    def __init__(self, rate_per_s: float, burst: int, most_keys: int = MOST_KEYS) -> None:
        self._rate_per_s, self._burst, self._most_keys = rate_per_s, burst, most_keys
        self._levels: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, key: str, now_s: float) -> float:
        """Take one; 0 when there was one, else the seconds until there will be."""
        wait_s = self.wait_s(key, now_s)
        if wait_s == 0.0:
            self._levels[key] = self._level(key, now_s) - 1.0, now_s
            self._levels.move_to_end(key)
            while len(self._levels) > self._most_keys:
                self._levels.popitem(last=False)
        return wait_s

    def wait_s(self, key: str, now_s: float) -> float:
        """Seconds until one can be taken."""
        missing = 1.0 - self._level(key, now_s)
        return max(0.0, missing / self._rate_per_s) if missing > 1e-9 else 0.0

    def __len__(self) -> int:
        return len(self._levels)

    def _level(self, key: str, now_s: float) -> float:
        level, then_s = self._levels.get(key, (float(self._burst), now_s))
        return min(float(self._burst), level + (now_s - then_s) * self._rate_per_s)
