"""`topnav down`: stop the launcher of a data folder, which stops its services."""

import os
import signal
import time
from pathlib import Path

from services.launcher.processes.state import StateFolder
from services.launcher.processes.wait import LaunchError

POLL_S = 0.05


def stop_stack(data_dir: Path, timeout_s: float) -> str:
    """Ask the launcher to stop, wait, and kill it if it does not; the kernel then kills its services.

    Returns:
        What happened, in one line.

    Raises:
        LaunchError: a launcher owns the folder but left no state to find it by.
    """
    folder = StateFolder(data_dir)
    if not folder.owned():
        folder.release()  # a killed launcher leaves its state file
        return f"no stack runs in {data_dir}"
    state = folder.read()
    if state is None:
        raise LaunchError(f"the stack in {data_dir} is just starting or stopping; try again in a second")
    os.kill(state.launcher_pid, signal.SIGTERM)
    if _released(folder, timeout_s):
        return "stopped"
    os.kill(state.launcher_pid, signal.SIGKILL)
    _released(folder, timeout_s)
    return f"the launcher did not stop within {timeout_s:.0f} s and was killed with its services"


def _released(folder: StateFolder, timeout_s: float) -> bool:
    deadline_s = time.monotonic() + timeout_s
    while folder.owned():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(POLL_S)
    return True
