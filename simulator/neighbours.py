"""Where the other robots of the place are, as their simulators say."""

import logging
from collections.abc import Iterator

from shared.bus import Bus
from shared.messages.simulation import Truth
from shared.topics import TRUTH

log = logging.getLogger(__name__)

SILENT_S = 5.0
"""Of whom nothing is heard for so long is gone; chosen: ten repetitions of a simulator that waits."""


class Neighbours:
    """Hears the truth of some robots."""

    def __init__(self, bus: Bus, names: tuple[str, ...], world: str) -> None:
        self._inboxes = {name: bus.subscribe(TRUTH, robot=name) for name in names}
        self._heard_s = dict.fromkeys(names, float("-inf"))
        self._world, self._elsewhere = world, set[str]()

    def news(self, now_s: float) -> Iterator[tuple[str, Truth | None]]:
        """Who is where and when, of those of whom something new is known; None of one that is gone.

        Args:
            now_s: monotonic.
        """
        for name, inbox in self._inboxes.items():
            truths = inbox.take_all()
            if truths and truths[-1].world == self._world:
                self._heard_s[name] = now_s
                yield name, truths[-1]
            elif truths:
                self._warn_once(name, truths[-1].world)
            elif 0.0 <= self._heard_s[name] < now_s - SILENT_S:
                self._heard_s[name] = float("-inf")
                yield name, None

    def _warn_once(self, name: str, world: str) -> None:
        if name not in self._elsewhere:
            self._elsewhere.add(name)
            log.warning("robot %s is in world %s and not in %s: it is not shown", name, world, self._world)
