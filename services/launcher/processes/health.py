"""Whether a service is ready: by its liveliness token, or by the health command of the Compose file."""

import logging
import subprocess
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path

from shared.bus import UnreachableError, open_bus

log = logging.getLogger(__name__)


Health = Callable[[], frozenset[str]]
"""Names what is ready of one service now; a restarted process brings a new name."""


class Liveliness:
    """Watches over one Zenoh session the liveliness tokens that `python -m shared.health` asks for."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._alive: defaultdict[str, set[str]] = defaultdict(set)
        self._stack = ExitStack()
        self._closing = threading.Event()
        self._joining: threading.Thread | None = None

    def open(self, endpoint: str, certs: Path | None = None) -> None:
        """Join the bus; returns at once, the router may come later."""
        if certs is None:
            self._join(endpoint, None)
            return
        self._joining = threading.Thread(target=self._join_when_up, args=(endpoint, certs), daemon=True)
        self._joining.start()

    def close(self) -> None:
        """Leave the bus."""
        self._closing.set()
        if self._joining is not None:
            self._joining.join()
        self._stack.close()

    def alive(self, service: str) -> frozenset[str]:
        """Return the instances of `service` that are alive."""
        with self._lock:
            return frozenset(self._alive[service])

    def _join_when_up(self, endpoint: str, certs: Path) -> None:
        """A client of a secured router cannot open before that is up: try until it is, or we close."""
        while not self._closing.is_set():
            try:
                self._join(endpoint, certs)
                return
            except UnreachableError as error:
                log.info("%s", error)

    def _join(self, endpoint: str, certs: Path | None) -> None:
        bus = self._stack.enter_context(open_bus(endpoint, certs=certs))
        bus.watch_alive(self._changed)

    def _changed(self, service: str, instance: str, alive: bool) -> None:
        with self._lock:
            (self._alive[service].add if alive else self._alive[service].discard)(instance)


class CommandHealth:
    """Ready while the last run of a command ended with 0. Never blocks: it runs in the background."""

    def __init__(
        self, command: tuple[str, ...], environment: Mapping[str, str], cwd: Path, interval_s: float
    ) -> None:
        self._command, self._environment, self._cwd = command, dict(environment), cwd
        self._interval_s = interval_s
        self._run: subprocess.Popen[bytes] | None = None
        self._next_s = 0.0
        self._ready = False
        self._count = 0

    def __call__(self) -> frozenset[str]:
        """Collect the last result and start the next run when it is due."""
        if self._run is not None and self._run.poll() is not None:
            self._ready = self._run.returncode == 0
            self._count += 1
            self._run = None
        if self._run is None and time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + self._interval_s
            self._run = subprocess.Popen(
                self._command,
                env=self._environment,
                cwd=self._cwd,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        # The count makes each success a new name: one that came after a restart is told from one before it.
        return frozenset({str(self._count)}) if self._ready else frozenset()

    def close(self) -> None:
        """End a run that is still going."""
        if self._run is not None:
            self._run.kill()
            self._run.wait()


def always_ready() -> frozenset[str]:
    """Of a service without a health check: ready once started, under a name no earlier process had."""
    return frozenset({str(time.monotonic_ns())})
