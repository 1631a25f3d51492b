"""What waits to be sent to one WebSocket: never blocks the sender, never grows without bound."""

import asyncio
from collections import deque

MAX_WAITING = 4096
"""Four full event queues of the bus: one burst must not look like a slow reader."""


class Outbox:
    """Events queue up in order; of states (status, heading, ranges) only the newest of each kind waits.

    Attributes:
        overflowed: the reader is so slow that events were lost; it must be dropped, not shown a gap.
    """

    def __init__(self) -> None:
        self._queue: deque[str] = deque()
        self._newest: dict[str, str] = {}
        self._filled = asyncio.Event()
        self.overflowed = False

    def offer(self, text: str) -> None:
        """Add something that must not be skipped."""
        if len(self._queue) >= MAX_WAITING:
            self.overflowed = True
        else:
            self._queue.append(text)
        self._filled.set()

    def offer_newest(self, kind: str, text: str) -> None:
        """Add something that replaces what waits of the same kind."""
        self._newest[kind] = text
        self._filled.set()

    async def take(self) -> list[str]:
        """Wait for something and return all of it, events first."""
        await self._filled.wait()
        self._filled.clear()
        texts = [*self._queue, *self._newest.values()]
        self._queue.clear()
        self._newest.clear()
        return texts
