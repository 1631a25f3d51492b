"""How long drive takes from a heading to its command, as planner and robot see it."""

import threading
import time
from itertools import count
from types import TracebackType
from typing import Self

import numpy as np

from shared.bus import open_bus
from shared.messages.drive import Velocity
from shared.messages.sensors import Frame
from shared.topics import FRAME, VELOCITY
from tests.integration.drive.conftest import Neighbours

PERIOD_S = 0.05
LOST_S = 1.0
FRAME_TURNS = 4
PICTURE = Frame(robot="r1", encoding="bgr8", width_px=1024, height_px=512, data=bytes(1024 * 512 * 3))


class Stopwatch:
    """A robot that senses 20 times a second, and a planner whose headings are timed."""

    def __init__(self, endpoint: str) -> None:
        self._endpoint = endpoint
        self._seq, self._stop = 1, threading.Event()
        self._robot = threading.Thread(target=self._sense, name="robot")

    def __enter__(self) -> Self:
        self._bus = open_bus(self._endpoint)
        bus = self._bus.__enter__()
        self._planner = Neighbours(bus)
        self._commands = bus.subscribe(VELOCITY, robot="r1")
        self._robot.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._robot.join()
        self._bus.__exit__(kind, error, trace)

    def latencies_s(self, during_s: float) -> list[float]:
        """One latency per heading sent at 20 Hz for a while; one without an answer counts LOST_S."""
        until_s, found = time.monotonic() + during_s, []
        while time.monotonic() < until_s:
            self._seq += 1
            self._commands.take_all()
            sent_s = time.monotonic()
            self._planner.wish(self._seq)
            found.append(self._answer(sent_s))
            time.sleep(max(0.0, sent_s + PERIOD_S - time.monotonic()))
        return found

    def warm_up(self) -> bool:
        """Whether drive answers within half a minute."""
        return any(min(self.latencies_s(0.1)) < LOST_S for _ in range(30))

    def _answer(self, sent_s: float) -> float:
        while (left_s := sent_s + LOST_S - time.monotonic()) > 0.0:
            command: Velocity | None = self._commands.wait(left_s)
            if command is not None and command.seq == self._seq:
                return time.monotonic() - sent_s
        return LOST_S

    def _sense(self) -> None:
        with open_bus(self._endpoint) as bus:
            robot, frames = Neighbours(bus), bus.publisher(FRAME, robot="r1")
            for turn in count():
                robot.see(self._seq)
                if turn % FRAME_TURNS == 0:
                    frames.put(PICTURE.model_copy(update={"seq": self._seq, "stamp_ns": time.time_ns()}))
                if self._stop.wait(PERIOD_S):
                    return


def told(latencies_s: list[float], name: str) -> dict[str, float]:
    """Figures in milliseconds."""
    return {
        f"{name}_{label}_ms": round(float(np.percentile(latencies_s, share)) * 1e3, 2)
        for label, share in (("p50", 50), ("p99", 99), ("max", 100))
    }
