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
"""Between two faults: from one that hits a stack just healthy again to one that lets it drive for a while."""

FROZEN_S, CUT_S = (0.5, 6.0), (0.3, 5.0)
"""Shorter and longer than what the bus takes for the end of a peer."""

BACK_S = 90.0
"""Six times what a hung service takes to be killed (15 s); all are healthy again within seconds as a rule."""

POLL_S = 0.1  # recoveries take seconds
NOTICED_S = 0.5
"""So soon the launcher knows what became of a process."""
SERVICES = ("planner", "features", "drive", "map-store", "gateway", "router", "simulator")
FAULTS = ("kill", "kill", "freeze", "freeze", "end", "cut")


class Chaos:
    """Does one thing after the other until `stop`, and waits until all is healthy again before the next."""

    def __init__(self, launcher: Launcher, journal: Journal, seed: int, *, may_cut: bool) -> None:
        self._launcher, self._journal = launcher, journal
        self._rng = np.random.default_rng(seed)
        self._faults = FAULTS if may_cut else tuple(fault for fault in FAULTS if fault != "cut")

    def run(self, stop: threading.Event) -> None:
        """Until `stop`."""
        while not stop.wait(float(self._rng.uniform(*PAUSE_S))):
            fault = str(self._rng.choice(self._faults))
            service = "" if fault == "cut" else str(self._rng.choice(SERVICES))
            at_s = rounded(self._journal.elapsed_s, 1)
            started_s, pid = time.monotonic(), self._launcher.pid(service) if service else None
            self._do(fault, service)
            healthy = self._healthy(stop, service, pid if fault in ("kill", "end") else None)
            after_s = rounded(time.monotonic() - started_s, 2) if healthy else None
            self._journal.add("events", at_s=at_s, harm=fault, service=service, healthy_after_s=after_s)
            if not healthy and not stop.is_set():
                states = {name: s.state.value for name, s in self._launcher.status().items()}
                self._journal.violation("every service returns", f"not healthy in {BACK_S} s: {states}")

    def _do(self, fault: str, service: str) -> None:
        doing: dict[str, Callable[[], None]] = {
            "kill": lambda: self._send(service, signal.SIGKILL),
            "end": lambda: self._send(service, signal.SIGTERM),
            "freeze": lambda: self._freeze(service),
            "cut": lambda: cut(float(self._rng.uniform(*CUT_S))),
        }
        doing[fault]()

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
