"""Slots for what goes on at once: so many in all, and so many for one client."""

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

from shared.web.problems import ProblemError


class Slots:
    """Counts what is open. Lives in the asyncio thread.

    Args:
        what: name in refusals.
        most: slots in all.
        most_per_client: slots of one client, so that one cannot take them all.
    """

    def __init__(self, what: str, most: int, most_per_client: int) -> None:
        self._what, self._most, self._most_per_client = what, most, min(most, most_per_client)
        self._open: Counter[str] = Counter()
        self.taken = 0

    @contextmanager
    def hold(self, client: str) -> Iterator[None]:
        """Hold a slot while the block runs.

        Raises:
            ProblemError: 503 all are taken, 429 this client has its share.
        """
        if self.taken >= self._most:
            raise self._refusal(503, self._most, "in all")
        if self._open[client] >= self._most_per_client:
            raise self._refusal(429, self._most_per_client, "of one client")
        self.taken += 1
        self._open[client] += 1
        try:
            yield
        finally:
            self.taken -= 1
            self._open[client] -= 1
            if not self._open[client]:
                del self._open[client]

    def _refusal(self, status: int, most: int, whose: str) -> ProblemError:
        expected = f"at most {most} {self._what} at once {whose}"
        return ProblemError(
            status, f"too_many_{self._what}", expected, "one more", "wait a second and try again"
        )
