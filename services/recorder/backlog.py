"""What Zenoh's threads brought and the recorder has not written yet."""

import threading
import time
from collections import Counter, deque
from dataclasses import dataclass

MAX_BYTES = 256_000_000  # four of the longest messages; seconds of everything that a robot says


@dataclass(frozen=True)
class Sample:
    """One message as it came: key, bytes, and the time of arrival on this machine's clock."""

    key: str
    payload: bytes
    arrived_ns: int


class Backlog:
    """A queue bounded in bytes. When the disk is too slow the newest samples are dropped and counted."""

    def __init__(self, wake: threading.Event, max_bytes: int = MAX_BYTES) -> None:
        self._wake, self._max_bytes = wake, max_bytes
        self._samples: deque[Sample] = deque()
        self._bytes = 0
        self._lock = threading.Lock()
        self._dropped: Counter[str] = Counter()

    def push(self, key: str, payload: bytes) -> None:
        """Store one payload; called on Zenoh's threads."""
        sample = Sample(key, payload, time.time_ns())
        with self._lock:
            if self._bytes + len(payload) > self._max_bytes:
                self._dropped[key] += 1
            else:
                self._samples.append(sample)
                self._bytes += len(payload)
        self._wake.set()

    def take_all(self) -> list[Sample]:
        """Everything that waits, in the order of arrival."""
        with self._lock:
            taken, self._samples, self._bytes = list(self._samples), deque(), 0
        return taken

    def dropped(self) -> dict[str, int]:
        """Samples lost so far, by key."""
        with self._lock:
            return dict(self._dropped)
