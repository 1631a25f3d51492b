"""What stands in for a robot: pictures of nothing, free floor around, an emergency stop and a battery."""

import threading
import time
from collections.abc import Callable
from itertools import count

import numpy as np

from shared.bus import Bus
from shared.messages.body import Battery
from shared.messages.estop import EStopState
from shared.messages.features import Features
from shared.messages.matching import MatchReply
from shared.messages.sensors import Ranges
from shared.topics import BATTERY, ESTOP_STATE, FEATURES, MATCH, RANGES

FRAME_S = 0.1
NUMBERS = np.zeros((1, 2), np.float32), np.zeros(1, np.float32), np.zeros((1, 4), np.uint8)


class Robot:
    """Says what a robot and its feature service say, ten times a second.

    Args:
        drives: says how the emergency stop stands as well, where no drive service does.
        name: of the robot.
    """

    def __init__(self, bus: Bus, drives: bool = True, name: str = "r1") -> None:
        self._name, self._frames, self._drives = name, count(1), drives
        self._features, self._ranges = bus.publisher(FEATURES, robot=name), bus.publisher(RANGES, robot=name)
        self._stops, self._batteries = (
            bus.publisher(ESTOP_STATE, robot=name),
            bus.publisher(BATTERY, robot=name),
        )
        self._matches = bus.requests(MATCH, robot=name)
        self.stopped, self._stop_count = False, 1
        self.charge: float | None = None
        self._end, self._said = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name="robot", daemon=True)

    def __enter__(self) -> "Robot":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join()

    def stop(self, engaged: bool) -> None:
        """Engage or clear the emergency stop, and say so."""
        self.stopped, self._stop_count = engaged, self._stop_count + 1
        self._said.clear()
        assert self._said.wait(10.0)

    def _run(self) -> None:
        while not self._end.wait(FRAME_S):
            self._look()
            if self._drives:
                state = {"engaged": self.stopped, "who": "anna", "why": "a child"}
                self._stops.put(EStopState(robot=self._name, seq=self._stop_count, **state))
            self._said.set()
            if self.charge is not None:
                self._batteries.put(Battery(robot=self._name, share=self.charge))
            while (question := self._matches.take()) is not None:
                asked = question.message
                question.reply(MatchReply(seq=asked.seq, map=asked.map, pipeline="x", max_similarity=150))

    def _look(self) -> None:
        now = {"seq": next(self._frames), "stamp_ns": time.time_ns(), "robot": self._name}
        lonlat, scores, descriptors = NUMBERS
        angles = tuple(k * 0.5 for k in range(12))
        self._ranges.put(Ranges(**now, angles_rad=angles, distances_m=(4.0,) * 12, max_range_m=4.0))
        self._features.put(
            Features(**now, pipeline="x", lonlat_rad=lonlat, scores=scores, descriptors=descriptors)
        )


def until(condition: Callable[[], object], timeout_s: float, why: str) -> None:
    """Wait for a condition, and say what did not come."""
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline_s, why
        time.sleep(FRAME_S)
