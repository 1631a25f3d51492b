"""Waiting: for samples, which Zenoh's threads store and a service's loop decodes, and for conditions."""

import logging
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from typing import Generic, TypeVar

from shared.messages.base import Message
from shared.wire import WireError, decode

M = TypeVar("M", bound=Message)
log = logging.getLogger(__name__)

WARN_PERIOD_S = 1.0
"""Of one kind of fault one line a second is logged, all are counted; chosen."""
QUEUE_BYTES = 64_000_000
"""What may wait in one queue, in all: the longest message (topics.FRAME); decision 0022."""


def queue_bytes(max_bytes: int) -> int:
    """How many bytes may wait in one queue, at least one longest message: what a flood can take from us."""
    return max(QUEUE_BYTES, max_bytes)


class Counters:
    """Counts of things that went wrong, by name; readable from any thread."""

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._warned_s: dict[str, float] = {}
        self._lock = threading.Lock()

    def count(self, name: str, detail: str) -> None:
        """Add one to `name`; log `detail` at most once a second per name."""
        now_s = time.monotonic()
        with self._lock:
            self._counts[name] += 1
            loud = now_s - self._warned_s.get(name, -WARN_PERIOD_S) >= WARN_PERIOD_S
            if loud:
                self._warned_s[name] = now_s
        if loud:
            log.warning("%s: %s", name, detail)

    def snapshot(self) -> dict[str, int]:
        """Copy of all counts."""
        with self._lock:
            return dict(self._counts)


class Inbox(Generic[M]):
    """Keeps the newest `capacity` payloads of one subscription and decodes them when they are taken.

    Payloads that are too long are never kept, and all that wait together are bounded in bytes too.
    """

    def __init__(
        self, kind: type[M], max_bytes: int, capacity: int, wake: threading.Event, counters: Counters
    ) -> None:
        self._kind, self._max_bytes = kind, max_bytes
        self._payloads: deque[bytes] = deque()
        self._waiting_bytes, self._most_bytes = 0, queue_bytes(max_bytes)
        self._wake, self._counters = wake, counters
        self._capacity, self._lock = capacity, threading.Lock()

    def admits(self, length: int) -> bool:
        """Whether a payload of `length` bytes may be a message; one that may not is counted."""
        if length <= self._max_bytes:
            return True
        schema = self._kind.SCHEMA
        self._counters.count("malformed", f"{schema}: at most {self._max_bytes} bytes expected, got {length}")
        return False

    def push(self, payload: bytes) -> None:
        """Store one payload; the oldest make room. Called on Zenoh's thread."""
        if not self.admits(len(payload)):
            return
        with self._lock:
            self._payloads.append(payload)
            self._waiting_bytes += len(payload)
            lost = 0
            while len(self._payloads) > self._capacity or self._waiting_bytes > self._most_bytes:
                self._waiting_bytes -= len(self._payloads.popleft())
                lost += 1
        for _ in range(lost if self._capacity > 1 else 0):
            self._counters.count("overflow", f"{self._kind.SCHEMA}: queue of {self._capacity} is full")
        self._wake.set()

    def take(self) -> M | None:
        """Return the oldest waiting message, or None. Malformed ones are counted and skipped."""
        while True:
            with self._lock:
                if not self._payloads:
                    return None
                payload = self._payloads.popleft()
                self._waiting_bytes -= len(payload)
            try:
                return decode(self._kind, payload, self._max_bytes)
            except WireError as error:
                self._counters.count("malformed", str(error))

    def take_all(self) -> list[M]:
        """Return everything that waits, oldest first."""
        messages = []
        while (message := self.take()) is not None:
            messages.append(message)
        return messages

    def wait(self, timeout_s: float) -> M | None:
        """Wait for a message up to `timeout_s`; None when none came. For loops with one subscription."""
        deadline_s = time.monotonic() + timeout_s
        while (message := self.take()) is None:
            left_s = deadline_s - time.monotonic()
            if left_s <= 0.0:
                return None
            self._wake.wait(left_s)
            self._wake.clear()
        return message


def wait_until(condition: Callable[[], bool], timeout_s: float, period_s: float = 0.02) -> bool:
    """Poll `condition`, which nothing announces, until it holds or `timeout_s` passes; whether it held."""
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(period_s)
    return True
