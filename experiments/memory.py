"""How much memory the services of a stack hold, read from /proc."""

from pathlib import Path

from experiments.output import rounded
from services.launcher.supervisor import Launcher

KB_PER_MB = 1024.0


def peak_memory_mb(launcher: Launcher | None) -> dict[str, float]:
    """Largest resident memory of each service so far, MB; empty where somebody else runs the stack."""
    if launcher is None:
        return {}
    pids = {name: status.pid for name, status in launcher.status().items()}
    found = {name: _peak_mb(pid) for name, pid in pids.items() if pid is not None}
    return {name: value for name, value in found.items() if value is not None}


def _peak_mb(pid: int) -> float | None:
    try:
        lines = Path(f"/proc/{pid}/status").read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return None
    for line in lines:
        if line.startswith("VmHWM:"):
            return rounded(float(line.split()[1]) / KB_PER_MB, 1)
    return None
