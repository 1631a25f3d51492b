"""How much memory the services of a stack hold, read from /proc."""

from pathlib import Path

from services.launcher.processes.supervisor import Launcher
from services.launcher.terminal.output import rounded

KB_PER_MB = 1024.0
PEAK, RESIDENT = "VmHWM", "VmRSS"


def peak_memory_mb(launcher: Launcher | None) -> dict[str, float]:
    """Largest resident memory of each service so far, MB; empty where somebody else runs the stack."""
    if launcher is None:
        return {}
    pids = {name: status.pid for name, status in launcher.status().items()}
    found = {name: memory_mb(pid, PEAK) for name, pid in pids.items() if pid is not None}
    return {name: value for name, value in found.items() if value is not None}


def memory_mb(pid: int, field: str) -> float | None:
    """PEAK or RESIDENT memory of a process, MB; None where it is gone."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return None
    for line in lines:
        if line.startswith(f"{field}:"):
            return rounded(float(line.split()[1]) / KB_PER_MB, 1)
    return None
