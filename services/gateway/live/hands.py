"""How people drive robots, from the web to the bus."""

import time
from collections import OrderedDict

from shared.bus import Bus, Publisher
from shared.messages.drive import Manual
from shared.topics import MANUAL

MOST_ROBOTS = 64
"""Publishers kept; the one used longest ago is closed first. Chosen: as many as are ever driven at once."""


class Hands:
    """Publishes wishes, each with a higher number than the one before. Lives in the asyncio thread."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._publishers: OrderedDict[str, Publisher[Manual]] = OrderedDict()
        self._seq = 0

    def wish(self, wish: Manual) -> None:
        """Pass on one wish. Numbers follow the clock: a gateway that restarted goes on above its last."""
        self._seq = max(self._seq + 1, time.time_ns() // 1_000_000)
        publisher = self._publishers.get(wish.robot) or self._bus.publisher(MANUAL, robot=wish.robot)
        self._publishers[wish.robot] = publisher
        self._publishers.move_to_end(wish.robot)
        while len(self._publishers) > MOST_ROBOTS:
            self._publishers.popitem(last=False)
        publisher.put(wish.model_copy(update={"seq": self._seq, "stamp_ns": time.time_ns()}))
