"""What a running stack leaves on disk so that `topnav status` and `topnav down` find it."""

import fcntl
import json
import os
from pathlib import Path
from typing import IO

from pydantic import BaseModel, ConfigDict

from services.launcher.processes.runner import State
from shared.bus import wait_until

LOOKERS_S = 0.5
"""Who looks whether a stack runs holds the lock for a moment; an owner keeps it."""


class ServiceStatus(BaseModel):
    """One service as of now."""

    model_config = ConfigDict(frozen=True)
    state: State
    pid: int | None = None
    restarts: int = 0
    last_exit: int | None = None


class StackState(BaseModel):
    """One running stack; `certs` is the certificate of the shell, None on an open one."""

    model_config = ConfigDict(frozen=True, extra="ignore")
    launcher_pid: int
    started: str
    endpoint: str
    gateway_url: str
    map_store_url: str
    logs: str
    certs: Path | None = None
    services: dict[str, ServiceStatus]

    @property
    def healthy(self) -> bool:
        """Whether every service is healthy."""
        return all(status.state is State.HEALTHY for status in self.services.values())


class AlreadyRunningError(RuntimeError):
    """Another launcher owns this data folder."""


class StateFolder:
    """`launcher/` in a data folder: state.json, the lock, and the logs."""

    def __init__(self, data_dir: Path) -> None:
        self.folder = data_dir / "launcher"
        self.logs = self.folder / "logs"
        self._state = self.folder / "state.json"
        self._lock_path = self.folder / "lock"
        self._lock: IO[str] | None = None

    def acquire(self) -> None:
        """Become the owner. The kernel drops the lock when the owner dies, however it dies.

        Raises:
            AlreadyRunningError: somebody else is.
        """
        self.logs.mkdir(parents=True, exist_ok=True)
        lock = self._lock_path.open("a+")
        if not wait_until(lambda: _locked(lock, fcntl.LOCK_EX), LOOKERS_S):
            lock.seek(0)
            owner = lock.read().strip()
            lock.close()
            raise AlreadyRunningError(
                f"a stack is already running in {self.folder.parent} (launcher pid {owner}): "
                "stop it with 'topnav down', or name another --data-dir"
            )
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        self._lock = lock

    def release(self) -> None:
        """Give the folder up and remove the state."""
        self._state.unlink(missing_ok=True)
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def write(self, state: StackState) -> None:
        """Replace the state in one step, so that no reader ever sees half of it."""
        new = self._state.with_suffix(".new")
        new.write_text(state.model_dump_json(indent=2), encoding="utf-8")
        new.replace(self._state)

    def read(self) -> StackState | None:
        """Return the state of the running stack; None when none runs, even if a killed one left its file."""
        if not self.owned():
            return None
        try:
            return StackState.model_validate(json.loads(self._state.read_text(encoding="utf-8")))
        except FileNotFoundError:
            return None

    def owned(self) -> bool:
        """Whether a living launcher holds the lock; any number of processes may look at once."""
        try:
            with self._lock_path.open("r") as lock:
                return not _locked(lock, fcntl.LOCK_SH)
        except FileNotFoundError:
            return False
        except OSError:
            return True


def _locked(lock: IO[str], kind: int) -> bool:
    try:
        fcntl.flock(lock, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
