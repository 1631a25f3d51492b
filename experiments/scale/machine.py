"""On what a figure was measured."""

import os
import platform
from pathlib import Path
from typing import Any

from experiments.output import rounded


def machine() -> dict[str, Any]:
    """Processor, cores, memory and how busy they are now."""
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    return {
        "processor": model or platform.machine(),
        "cores": len(os.sched_getaffinity(0)),
        "memory_gb": rounded(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1),
        "load_at_start": rounded(os.getloadavg()[0], 1),
        "python": platform.python_version(),
    }
