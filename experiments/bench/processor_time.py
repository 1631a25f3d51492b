"""How much processor time the services of a stack take, read from /proc."""

import os
import time
from collections.abc import Iterable
from pathlib import Path

from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal.output import rounded

TICKS_PER_S = os.sysconf("SC_CLK_TCK")
USER, SYSTEM = 11, 12
"""Of the fields of /proc/PID/stat after the name, which may hold blanks and brackets."""


def processor_s(pid: int) -> float | None:
    """Seconds of processor time of a process and all its threads so far; None where it is gone."""
    try:
        stat = Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace")
    except OSError:
        return None
    fields = stat.rpartition(")")[2].split()
    return (int(fields[USER]) + int(fields[SYSTEM])) / TICKS_PER_S


def processors_s(pids: Iterable[int]) -> float:
    """The same of several processes together; those that are gone count nothing."""
    return sum(processor_s(pid) or 0.0 for pid in pids)


class ServiceTimes:
    """Processor time of each service of a stack from its making on; of none where somebody else runs it."""

    def __init__(self, launcher: Launcher | None) -> None:
        self._launcher = launcher
        self._before, self._start_s = self._now(), time.monotonic()

    def figures(self, steps: int) -> dict[str, dict[str, float]]:
        """Of each service that did not restart: share of one core, and milliseconds a step of the mission."""
        wall_s, now = time.monotonic() - self._start_s, self._now()
        spent = {
            name: s - self._before[name, pid] for (name, pid), s in now.items() if (name, pid) in self._before
        }
        return {
            name: {"cores": rounded(s / wall_s), "ms_per_step": rounded(1e3 * s / max(steps, 1), 2)}
            for name, s in sorted(spent.items())
        }

    def _now(self) -> dict[tuple[str, int], float]:
        status = self._launcher.status() if self._launcher is not None else {}
        pids = {(name, each.pid) for name, each in status.items() if each.pid is not None}
        return {(name, pid): s for name, pid in pids if (s := processor_s(pid)) is not None}
