"""One child process in its own process group, with its output in a log file."""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

CHILD = Path(__file__).with_name("child.py")
LOG_BYTES = 10_000_000
"""Chosen: with the old one beside it 20 MB a service."""
REAP_S = 5.0  # SIGKILL acts at once but for a process in the kernel


class ChildProcess:
    """Started on construction. Construct it in a thread that lives as long as the launcher.

    The kernel sends the death signal of `child.py` when the *thread* that started the child ends.

    Args:
        command: words of the command line.
        environment: variables on top of this process's own.
        log_path: file to which standard output and error are appended.
        cwd: working folder.
    """

    def __init__(
        self, command: Sequence[str], environment: Mapping[str, str], log_path: Path, cwd: Path
    ) -> None:
        log_path.parent.mkdir(parents=True, exist_ok=True)
        rotate(log_path)
        with log_path.open("ab") as output:
            self._process = subprocess.Popen(
                [sys.executable, "-I", "-S", str(CHILD), str(os.getpid()), *command],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                cwd=cwd,
                env={**os.environ, "PYTHONUNBUFFERED": "1", **environment},
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        """Process id, also the id of its process group."""
        return self._process.pid

    def exit_code(self) -> int | None:
        """Return the exit code (negative: killed by that signal), None while it runs."""
        return self._process.poll()

    def send(self, number: signal.Signals) -> None:
        """Send a signal to the whole group; a group that is gone is no error."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.pid, number)

    def wait(self, timeout_s: float) -> bool:
        """Wait for the end; returns whether it came."""
        try:
            self._process.wait(max(0.0, timeout_s))
        except subprocess.TimeoutExpired:
            return False
        return True


def stop_all(children: Mapping[ChildProcess, float]) -> None:
    """Send SIGTERM to all and SIGKILL to each that is left after its grace in seconds, then reap them."""
    for child in children:
        child.send(signal.SIGCONT)  # a stopped process could not act on SIGTERM
        child.send(signal.SIGTERM)
    start_s = time.monotonic()
    for child, grace_s in sorted(children.items(), key=lambda item: item[1]):
        child.wait(start_s + grace_s - time.monotonic())
        child.send(signal.SIGKILL)  # also to children that a service left in its group
        child.wait(REAP_S)


def rotate(path: Path, limit_bytes: int = LOG_BYTES) -> None:
    """Keep one old log beside the new one once it has grown past the limit.

    The file stays the one that a running process appends to: it is copied and emptied. Where there is no room
    for the copy, what is in it goes.
    """
    if not path.exists() or path.stat().st_size <= limit_bytes:
        return
    old = path.with_suffix(path.suffix + ".1")
    try:
        shutil.copyfile(path, old)
    except OSError:
        old.unlink(missing_ok=True)
    os.truncate(path, 0)
