"""A passive listener that notes when each message of a robot arrives. It asks nothing and answers nothing."""

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, Self

from experiments.bench.stages import Arrival
from services.launcher.client.address import Address
from shared.bus import Bus
from shared.messages.base import Message
from shared.messages.sensors import Frame
from shared.topics import EVENT, FEATURES, FRAME, HEADING, TRUTH, VELOCITY

LOOP = {"truth": TRUTH, "features": FEATURES, "heading": HEADING, "command": VELOCITY, "event": EVENT}
"""What the stages of the control loop are told from, in the order of a frame."""

ENDS = {"frame": FRAME, "command": VELOCITY}
"""What the latency is told from, by a listener of its own: decoding pictures would delay other stamps."""

READY_S = 60.0
"""A session opens within seconds, also on a loaded machine."""

PERIOD_S = 0.2  # wakes at once when something comes; so soon it ends


class Background(ABC):
    """Runs `_run` in a thread beside a block: it sets `_ready` when that may begin and ends on `_stop`."""

    def __init__(self, name: str) -> None:
        self._stop, self._ready = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name=name)

    def __enter__(self) -> Self:
        """Start, and wait until it is ready.

        Raises:
            TimeoutError: it was not within a minute.
        """
        self._thread.start()
        if not self._ready.wait(READY_S):
            self._stop.set()
            raise TimeoutError(f"{self._thread.name}: expected it to be ready within {READY_S:.0f} s")
        return self

    def __exit__(self, *_: object) -> None:
        """Stop, and wait for the end."""
        self._stop.set()
        self._thread.join()

    @abstractmethod
    def _run(self) -> None: ...


class Listener(Background):
    """Listens on a session and a thread of its own; `arrivals` is complete after the `with` block."""

    def __init__(
        self, address: Address, robot: str, topics: Mapping[str, Any] = LOOP, most: int | None = None
    ) -> None:
        """Listen to these topics of a robot; after `most` messages stop keeping them."""
        super().__init__("bench-listener")
        self._address, self._robot, self._topics, self._most = address, robot, topics, most
        self.arrivals: list[Arrival] = []

    def _run(self) -> None:
        with self._address.open() as bus:
            inboxes = [(name, _subscribe(bus, topic, self._robot)) for name, topic in self._topics.items()]
            inboxes.reverse()  # what a message follows from is there before it, so never stamped later
            self._ready.set()
            while not self._stop.is_set():
                if bus.wait(PERIOD_S):
                    now_s = time.perf_counter()  # before decoding: that would delay the stamp
                    for name, inbox in inboxes:
                        news = [Arrival(name, now_s, _light(message)) for message in inbox.take_all()]
                        if self._most is None or len(self.arrivals) < self._most:
                            self.arrivals.extend(news)


def _subscribe(bus: Bus, topic: Any, robot: str) -> Any:
    return bus.subscribe(topic, robot=robot)


def _light(message: Message) -> Message:
    """Without its picture: a minute of frames would fill the memory."""
    return message.model_copy(update={"data": b""}) if isinstance(message, Frame) else message
