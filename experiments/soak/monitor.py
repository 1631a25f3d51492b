"""Looks on: whether the robot touches anything, and how much memory everybody holds."""

import threading
import time
from dataclasses import asdict

from experiments.bench.resources import RESIDENT, memory_mb
from experiments.soak.growth import Sample
from experiments.soak.journal import Journal
from services.launcher.processes.supervisor import Launcher
from shared.bus import open_bus
from shared.messages.simulation import Truth
from shared.topics import TRUTH

PERIOD_S = 0.5  # every truth is kept until then
MEMORY_PERIOD_S = 30.0  # 120 samples an hour for a slope


class Monitor:
    """Counts collisions from the simulator's truth and samples resident memory."""

    def __init__(self, launcher: Launcher, robot: str, journal: Journal, most_mb: float) -> None:
        self._launcher, self._robot, self._journal = launcher, robot, journal
        self._most_mb, self._too_large = most_mb, set[str]()
        self._last: Truth | None = None

    def run(self, stop: threading.Event) -> None:
        """Until `stop`."""
        sampled_s = -MEMORY_PERIOD_S
        with open_bus(self._launcher.endpoint) as bus:
            truths = bus.subscribe(TRUTH, robot=self._robot)
            while not stop.wait(PERIOD_S):
                for truth in truths.take_all():
                    self._look(truth)
                if time.monotonic() - sampled_s >= MEMORY_PERIOD_S:
                    sampled_s = time.monotonic()
                    self._sample()

    def _look(self, truth: Truth) -> None:
        """The counter starts again at 0 with the simulator."""
        before = self._last.collisions if self._last is not None else truth.collisions
        if truth.collisions > before:
            where = f"({truth.pose.x_m:.2f}, {truth.pose.y_m:.2f}) at {truth.speed_mps:.2f} m/s"
            self._journal.violation("no collision", f"{truth.collisions - before} at {where}")
        self._last = truth

    def _sample(self) -> None:
        at_s = round(self._journal.elapsed_s, 1)
        for name, status in self._launcher.status().items():
            mb = memory_mb(status.pid, RESIDENT) if status.pid is not None else None
            if mb is None or status.pid is None:
                continue
            self._journal.add("memory", **asdict(Sample(name, status.pid, at_s, mb)))
            if mb > self._most_mb and name not in self._too_large:
                self._too_large.add(name)
                self._journal.violation("memory is bounded", f"{name} holds {mb} MB")
