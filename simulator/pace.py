"""Robots of one place in lockstep wait for one another: none drives through a world that stands. Pure.

Each advances when its own planner has answered: one that waits for others answers quickest, and seconds of
its time would pass within one frame of those it waits for.
"""

AHEAD_S = 0.45
"""Who is so far ahead of another waits; chosen: one frame and a half."""
PATIENCE_S = 5.0
"""Whose time stands so long is not waited for; chosen: a frame of eight robots on two cores takes two."""


class Pace:
    """The time of one robot against that of its company.

    Only what passes while both are there counts, and at most AHEAD_S of it either way: who has stood for an
    hour keeps nobody for an hour.
    """

    def __init__(self) -> None:
        self._lead_s: dict[str, float] = {}
        self._stamps_ns: dict[str, int] = {}
        self._moved_s: dict[str, float] = {}

    def passed(self, period_s: float) -> None:
        """The own time goes on."""
        most_s = AHEAD_S + period_s
        self._lead_s = {name: min(lead_s + period_s, most_s) for name, lead_s in self._lead_s.items()}

    def heard(self, name: str, stamp_ns: int, now_s: float) -> None:
        """Another robot says what time it has; `now_s` is monotonic."""
        passed_s = 1e-9 * (stamp_ns - self._stamps_ns.get(name, stamp_ns))
        if name not in self._lead_s:
            self._lead_s[name], self._moved_s[name] = 0.0, now_s
        elif passed_s:
            self._lead_s[name] = max(self._lead_s[name] - passed_s, -AHEAD_S)
            self._moved_s[name] = now_s
        self._stamps_ns[name] = stamp_ns

    def gone(self, name: str) -> None:
        """Nothing is heard of it any more."""
        for known in (self._lead_s, self._stamps_ns, self._moved_s):
            known.pop(name, None)

    def is_ahead(self, now_s: float) -> bool:
        """Whether somebody is to be waited for."""
        return any(
            lead_s > AHEAD_S and now_s - self._moved_s[name] < PATIENCE_S
            for name, lead_s in self._lead_s.items()
        )
