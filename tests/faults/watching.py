"""Watching the wheels and the messages of a robot while something is killed."""

import threading
import time
from types import TracebackType
from typing import Self

from shared.bus import Bus, open_bus
from shared.topics import COMMAND, FEATURES, HEADING, TRUTH

TOPICS = {"truth": TRUTH, "features": FEATURES, "planner": HEADING, "drive": COMMAND}
MOVING_MPS = 0.1
STILL_MPS = 0.03


class Watch:
    """Notes when each message arrived, and the true speed; a session and a thread of its own."""

    def __init__(self, endpoint: str, robot: str) -> None:
        self._endpoint, self._robot = endpoint, robot
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="watch")
        self.speeds: list[tuple[float, float]] = []
        self.arrivals: dict[str, list[float]] = {name: [] for name in TOPICS}

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()

    def moving(self) -> bool:
        """Whether the robot is driving now."""
        return bool(self.speeds) and self.speeds[-1][1] > MOVING_MPS

    def still_after_s(self, since_s: float) -> float | None:
        """Time from `since_s` to the first true state at rest; None when there was none."""
        rest = [time_s for time_s, speed in self.speeds if time_s >= since_s and speed < STILL_MPS]
        return rest[0] - since_s if rest else None

    def fastest_mps(self, since_s: float) -> float:
        """Highest true speed from `since_s` on; infinite when nothing was heard: silence proves nothing."""
        return max((speed for time_s, speed in self.speeds if time_s >= since_s), default=float("inf"))

    def back_after_s(self, service: str, since_s: float, quiet_s: float = 0.05) -> float | None:
        """Time from `since_s` to the service's first message; those already under way do not count."""
        later = [time_s for time_s in self.arrivals.get(service, []) if time_s > since_s + quiet_s]
        return later[0] - since_s if later else None

    def _listen(self) -> None:
        with open_bus(self._endpoint) as bus:
            inboxes = {name: self._subscribe(bus, name) for name in TOPICS}
            while not self._stop.is_set():
                bus.wait(0.2)
                now_s = time.monotonic()
                for name, inbox in inboxes.items():
                    for message in inbox.take_all():
                        self.arrivals[name].append(now_s)
                        if name == "truth":
                            self.speeds.append((now_s, message.speed_mps))

    def _subscribe(self, bus: Bus, name: str):
        return bus.subscribe(TOPICS[name], robot=self._robot)
