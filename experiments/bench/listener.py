"""A passive listener that notes when each message of a frame arrives. It asks nothing and answers nothing."""

import time
from typing import Any

from experiments.bench.background import Background
from experiments.bench.stages import Arrival
from services.launcher.client.address import Address
from shared.bus import Bus
from shared.topics import COMMAND, EVENT, FEATURES, HEADING, TRUTH

TOPICS = {"truth": TRUTH, "features": FEATURES, "heading": HEADING, "command": COMMAND, "event": EVENT}
PERIOD_S = 0.2


class Listener(Background):
    """Listens on a session and a thread of its own; `arrivals` is complete after the `with` block."""

    def __init__(self, address: Address, robot: str, most: int | None = None) -> None:
        """Listen to a robot; after `most` messages stop keeping them."""
        self._address, self._robot, self._most = address, robot, most
        super().__init__("bench-listener")
        self.arrivals: list[Arrival] = []

    def _run(self) -> None:
        with self._address.open() as bus:
            inboxes = {name: _subscribe(bus, topic, self._robot) for name, topic in TOPICS.items()}
            self._ready.set()
            while not self._stop.is_set():
                if bus.wait(PERIOD_S):
                    now_s = time.perf_counter()  # before decoding: that would delay the stamp
                    for name, inbox in inboxes.items():
                        news = [Arrival(name, now_s, message) for message in inbox.take_all()]
                        if self._most is None or len(self.arrivals) < self._most:
                            self.arrivals.extend(news)


def _subscribe(bus: Bus, topic: Any, robot: str) -> Any:
    return bus.subscribe(topic, robot=robot)
