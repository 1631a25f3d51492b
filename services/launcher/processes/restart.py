"""When to start a dead process again: at once the first time, ever later in a crash storm. Pure."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RestartPolicy:
    """Exponential back-off over the exits of the recent past.

    Attributes:
        first_s: pause before the first restart, that of Docker.
        factor: growth of the pause per further exit within the window.
        longest_s: upper bound of the pause.
        window_s: how long an exit counts.
        storm_exits: so many exits within the window are a crash storm: the service is degraded.
        settle_s: a degraded service must stay ready for so long to count as healthy again.
    """

    first_s: float = 0.1
    factor: float = 3.0
    longest_s: float = 10.0
    window_s: float = 60.0
    storm_exits: int = 5
    settle_s: float = 5.0

    def recent(self, exits_s: tuple[float, ...], now_s: float) -> tuple[float, ...]:
        """Return the exit times that still count."""
        return tuple(t for t in exits_s if now_s - t < self.window_s)

    def pause_s(self, exits_s: tuple[float, ...], now_s: float) -> float:
        """Return the pause before the next start, after at least one exit."""
        count = len(self.recent(exits_s, now_s))
        return min(self.longest_s, self.first_s * self.factor ** max(0, count - 1))

    def is_storm(self, exits_s: tuple[float, ...], now_s: float) -> bool:
        """Tell whether the service keeps crashing."""
        return len(self.recent(exits_s, now_s)) >= self.storm_exits
