"""What Zenoh's threads brought and the live view has not shown yet: the newest, as it shows the present."""

import threading
import time
from collections import deque

from services.recorder.backlog import Sample
from shared.bus import CAPACITY
from shared.inbox import Counters
from shared.messages.base import Message
from shared.topics import Topic

MAX_KEYS = 512
"""Streams shown; chosen: thirty robots. A peer that invents names takes no more."""
MAX_BYTES = 128_000_000
"""Waiting in all; chosen: two of the longest messages, seconds of everything that a robot says."""


class Newest:
    """As many samples of each key as its topic keeps for any reader; older ones make room and are counted."""

    def __init__(self, wake: threading.Event, counters: Counters, max_bytes: int = MAX_BYTES) -> None:
        self._wake, self._counters, self._max_bytes = wake, counters, max_bytes
        self._waiting: dict[str, deque[Sample]] = {}
        self._bytes = 0
        self._lock = threading.Lock()

    def push(self, topic: Topic[Message], key: str, payload: bytes) -> None:
        """Store one payload; called on Zenoh's threads."""
        sample = Sample(key, payload, time.time_ns())
        with self._lock:
            lost = self._keep(sample, CAPACITY[topic.delivery])
        self._wake.set()
        if lost:
            self._counters.count("overflow", f"{key}: more comes than can be shown")

    def take_all(self) -> list[Sample]:
        """Everything that waits, by time of arrival."""
        with self._lock:
            taken = [sample for waiting in self._waiting.values() for sample in waiting]
            for waiting in self._waiting.values():
                waiting.clear()
            self._bytes = 0
        return sorted(taken, key=lambda sample: sample.arrived_ns)

    def _keep(self, sample: Sample, capacity: int) -> bool:
        """Whether something is lost that would have been shown: of a topic of one, an older one is not."""
        if sample.key not in self._waiting:
            if len(self._waiting) >= MAX_KEYS:
                return True
            self._waiting[sample.key] = deque()
        waiting, lost = self._waiting[sample.key], False
        if len(waiting) >= capacity:
            self._bytes -= len(waiting.popleft().payload)
            lost = capacity > 1
        if self._bytes + len(sample.payload) > self._max_bytes:
            return True
        waiting.append(sample)
        self._bytes += len(sample.payload)
        return lost
