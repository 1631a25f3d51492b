"""Runs between fork and exec of every service: ties its life to the launcher's.

Called as a script, `child.py LAUNCHER_PID COMMAND...`. The kernel kills the service when the launcher dies,
even by kill -9, so no orphan ever holds a port or drives a wheel. A script of its own because Python code
after a fork is not safe in a launcher that has Zenoh's threads.
"""

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1  # linux/prctl.h


def main(launcher_pid: int, command: list[str]) -> None:
    """Ask for SIGKILL at the launcher's death, then become `command`."""
    ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != launcher_pid:  # it died before the request was in force
        sys.exit(1)
    try:
        os.execvp(command[0], command)
    except OSError as error:
        sys.exit(f"cannot run {command[0]}: {error.strerror}")


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:])
