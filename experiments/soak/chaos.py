"""What breaks, at random: processes are killed, frozen, asked to end; the network is cut."""

import contextlib
import signal
import threading
import time
from collections.abc import Callable

import numpy as np

from experiments.soak.journal import Journal
from experiments.soak.network import cut
from services.launcher.processes.supervisor import Launcher
from services.launcher.processes.wait import LaunchError
from services.launcher.terminal.output import rounded

PAUSE_S = (5.0, 25.0)
FROZEN_S = (0.5, 6.0)
CUT_S = (0.3, 5.0)
BACK_S = 90.0
POLL_S = 0.1
NOTICED_S = 0.5
"""So soon the launcher knows what became of a process."""
SERVICES = ("planner", "features", "drive", "map-store", "gateway", "router", "simulator")
HARMS = ("kill", "kill", "freeze", "freeze", "end", "cut")


class Chaos:
    """Does one thing after the other until `stop`, and waits until all is healthy again before the next."""

    def __init__(self, launcher: Launcher, journal: Journal, seed: int, *, may_cut: bool) -> None:
        self._launcher, self._journal = launcher, journal
        self._rng = np.random.default_rng(seed)
        self._harms = HARMS if may_cut else tuple(harm for harm in HARMS if harm != "cut")

    def run(self, stop: threading.Event) -> None:
        """Until `stop`."""
        while not stop.wait(float(self._rng.uniform(*PAUSE_S))):
            harm = str(self._rng.choice(self._harms))
            service = "" if harm == "cut" else str(self._rng.choice(SERVICES))
            at_s = rounded(self._journal.elapsed_s, 1)
            started_s, pid = time.monotonic(), self._launcher.pid(service) if service else None
            self._do(harm, service)
            healthy = self._healthy(stop, service, pid if harm in ("kill", "end") else None)
            after_s = rounded(time.monotonic() - started_s, 2) if healthy else None
            self._journal.event(at_s=at_s, harm=harm, service=service, healthy_after_s=after_s)
            if not healthy and not stop.is_set():
                states = {name: s.state.value for name, s in self._launcher.status().items()}
                self._journal.violation("every service returns", f"not healthy in {BACK_S} s: {states}")

    def _do(self, harm: str, service: str) -> None:
        doing: dict[str, Callable[[], None]] = {
            "kill": lambda: self._send(service, signal.SIGKILL),
            "end": lambda: self._send(service, signal.SIGTERM),
            "freeze": lambda: self._freeze(service),
            "cut": lambda: cut(float(self._rng.uniform(*CUT_S))),
        }
        doing[harm]()

    def _freeze(self, service: str) -> None:
        self._send(service, signal.SIGSTOP)
        try:
            time.sleep(float(self._rng.uniform(*FROZEN_S)))
        finally:
            self._send(service, signal.SIGCONT)

    def _send(self, service: str, number: signal.Signals) -> None:
        with contextlib.suppress(LaunchError):  # it is just down
            self._launcher.kill(service, number)

    def _healthy(self, stop: threading.Event, service: str, ended_pid: int | None) -> bool:
        """Wait until all is healthy again, a process that had to end as another one."""
        time.sleep(NOTICED_S)
        deadline_s = time.monotonic() + BACK_S
        while time.monotonic() < deadline_s and not stop.is_set():
            now = self._launcher.status()
            replaced = ended_pid is None or now[service].pid != ended_pid
            if replaced and all(status.state.value == "healthy" for status in now.values()):
                return True
            time.sleep(POLL_S)
        return stop.is_set()
