"""A thread that works as long as a `with` block runs."""

import threading
from abc import ABC, abstractmethod
from types import TracebackType
from typing import Self

READY_S = 60.0


class Background(ABC):
    """Runs `_run` beside the block: it sets `_ready` when the block may begin and ends on `_stop`."""

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

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop, and wait for the end."""
        self._stop.set()
        self._thread.join()

    @abstractmethod
    def _run(self) -> None: ...
