"""What a machine is, and what processes on it take: processor time and memory, read from /proc."""

import os
import platform
import time
from collections.abc import Iterable
from pathlib import Path

from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal.output import rounded

TICKS_PER_S = os.sysconf("SC_CLK_TCK")
USER, SYSTEM = 11, 12
"""Of the fields of /proc/PID/stat after the name, which may hold blanks and brackets."""

KB_PER_MB = 1024.0  # /proc counts in KiB
PEAK, RESIDENT = "VmHWM", "VmRSS"


def machine() -> dict[str, object]:
    """On what figures are measured."""
    pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    lines = _lines(Path("/proc/cpuinfo"))
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return {
        "processor": names[0] if names else platform.machine(),
        "cpus": os.cpu_count(),
        "memory_gb": rounded(pages / 1e9, 1),
        "system": platform.platform(),
        "python": platform.python_version(),
        "load_1min": rounded(os.getloadavg()[0], 2),
    }


def processor_s(pid: int) -> float | None:
    """Seconds of processor time of a process and all its threads so far; None where it is gone."""
    fields = " ".join(_lines(Path(f"/proc/{pid}/stat"))).rpartition(")")[2].split()
    return (int(fields[USER]) + int(fields[SYSTEM])) / TICKS_PER_S if fields else None


def processors_s(pids: Iterable[int]) -> float:
    """The same of several processes together; those that are gone count nothing."""
    return sum(processor_s(pid) or 0.0 for pid in pids)


def memory_mb(pid: int, field: str) -> float | None:
    """PEAK or RESIDENT memory of a process, MB; None where it is gone."""
    for line in _lines(Path(f"/proc/{pid}/status")):
        if line.startswith(f"{field}:"):
            return rounded(float(line.split()[1]) / KB_PER_MB, 1)
    return None


def peak_memory_mb(launcher: Launcher | None) -> dict[str, float]:
    """Largest resident memory of each service so far, MB; empty where somebody else runs the stack."""
    found = {name: memory_mb(pid, PEAK) for name, pid in _pids(launcher).items()}
    return {name: value for name, value in found.items() if value is not None}


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
        pids = _pids(self._launcher)
        return {(name, pid): s for name, pid in pids.items() if (s := processor_s(pid)) is not None}


def _pids(launcher: Launcher | None) -> dict[str, int]:
    status = launcher.status() if launcher is not None else {}
    return {name: each.pid for name, each in status.items() if each.pid is not None}


def _lines(path: Path) -> list[str]:
    """Lines of a file of the system; none where it is gone."""
    try:
        return path.read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return []
