"""A passive listener that notes when each message of a frame arrives. It asks nothing and answers nothing."""

import threading
import time
from types import TracebackType
from typing import Any, Self

from experiments.address import Address
from experiments.bench_stages import Arrival
from shared.bus import Bus
from shared.topics import COMMAND, EVENT, FEATURES, HEADING, TRUTH

TOPICS = {"truth": TRUTH, "features": FEATURES, "heading": HEADING, "command": COMMAND, "event": EVENT}
PERIOD_S = 0.2


class Listener:
    """Listens on a session and a thread of its own; `arrivals` is complete after the `with` block."""

    def __init__(self, address: Address, robot: str, most: int | None = None) -> None:
        """Listen to a robot; after `most` messages stop keeping them."""
        self._address, self._robot, self._most = address, robot, most
        self._stop, self._ready = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._listen, name="bench-listener")
        self.arrivals: list[Arrival] = []

    def __enter__(self) -> Self:
        """Start listening."""
        self._thread.start()
        self._ready.wait(10.0)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop listening."""
        self._stop.set()
        self._thread.join()

    def _listen(self) -> None:
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
