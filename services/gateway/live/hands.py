"""How people drive robots, from the web to the bus."""

import time

from shared.bus import Bus, Publisher
from shared.messages.drive import Manual
from shared.topics import MANUAL


class Hands:
    """Publishes wishes, each with a higher number than the one before. Lives in the asyncio thread."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._publishers: dict[str, Publisher[Manual]] = {}
        self._seq = 0

    def wish(self, wish: Manual) -> None:
        """Pass on one wish. Numbers follow the clock: a gateway that restarted goes on above its last."""
        self._seq = max(self._seq + 1, time.time_ns() // 1_000_000)
        if wish.robot not in self._publishers:  # only robots that were heard of are driven
            self._publishers[wish.robot] = self._bus.publisher(MANUAL, robot=wish.robot)
        self._publishers[wish.robot].put(
            wish.model_copy(update={"seq": self._seq, "stamp_ns": time.time_ns()})
        )
