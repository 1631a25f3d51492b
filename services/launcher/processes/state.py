"""What a running stack leaves on disk so that `topnav status` and `topnav down` find it."""

import fcntl
import os
import time
from pathlib import Path
from typing import IO

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from services.launcher.processes.runner import State
from shared.bus import wait_until

LOOKERS_S = 0.5
"""Who looks whether a stack runs holds the lock for a moment; an owner keeps it."""

SILENT_S = 10.0
"""A launcher that has not said for so long that it runs hangs or was stopped: it says so every second."""


class ServiceStatus(BaseModel):
    """One service as of now."""

    model_config = ConfigDict(frozen=True)
    state: State
    pid: int | None = None
    restarts: int = 0
    last_exit: int | None = None


class StackState(BaseModel):
    """One running stack; `certs` is the certificate of the shell, None on an open one.

    Attributes:
        world: what its simulator was started with; "" where it has none.
        silent_s: since when nothing was heard of the launcher, as who reads it sees it.
    """

    model_config = ConfigDict(frozen=True, extra="ignore")
    launcher_pid: int = Field(gt=1)
    started: str
    endpoint: str
    gateway_url: str
    map_store_url: str
    logs: str
    certs: Path | None = None
    world: str = ""
    services: dict[str, ServiceStatus]
    silent_s: float = 0.0

    @property
    def silent(self) -> bool:
        """Whether the launcher hangs: then nobody starts again what dies."""
        return self.silent_s > SILENT_S

    @property
    def healthy(self) -> bool:
        """Whether every service is healthy and looked after."""
        return not self.silent and all(status.state is State.HEALTHY for status in self.services.values())


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
        self._state.unlink(missing_ok=True)  # of a launcher that was killed
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
        """Return the state of the running stack; None when none runs, even if a killed one left its file.

        Services whose processes are gone are told as such, whatever the launcher wrote last.
        """
        owner = self.owner()
        try:
            state = StackState.model_validate_json(self._state.read_bytes())
            silent_s = time.time() - self._state.stat().st_mtime
        except (FileNotFoundError, ValidationError):
            return None
        if state.launcher_pid != owner:
            return None
        services = {name: _as_it_is(service) for name, service in state.services.items()}
        return state.model_copy(update={"services": services, "silent_s": max(0.0, silent_s)})

    def beat(self) -> None:
        """Say that the launcher runs."""
        if self._state.exists():
            os.utime(self._state)

    def owner(self) -> int | None:
        """Process id of the launcher that holds the lock, as the kernel knows it; None where there is none.

        What stands in files may be of a launcher that was killed: its process id may be another's by now.
        """
        if not self.owned():
            return None
        of = self._lock_path.stat()
        file = f"{os.major(of.st_dev):02x}:{os.minor(of.st_dev):02x}:{of.st_ino}"
        for line in Path("/proc/locks").read_text(encoding="ascii").splitlines():
            _, kind, _, mode, pid, where, *_ = line.replace("-> ", "").split()
            if (kind, mode, where) == ("FLOCK", "WRITE", file):
                return int(pid)
        # A file system whose inodes have other numbers among the locks: the owner has written its own.
        written = self._lock_path.read_text(encoding="ascii")
        return int(written) if written.isdecimal() and int(written) > 1 else None

    def owned(self) -> bool:
        """Whether a living launcher holds the lock; any number of processes may look at once."""
        try:
            with self._lock_path.open("r") as lock:
                return not _locked(lock, fcntl.LOCK_SH)
        except FileNotFoundError:
            return False
        except OSError:
            return True


def _as_it_is(service: ServiceStatus) -> ServiceStatus:
    if service.pid is None or _runs(service.pid):
        return service
    return service.model_copy(update={"state": State.EXITED, "pid": None})


def _runs(pid: int) -> bool:
    """Whether a process lives; one that nobody has reaped does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def _locked(lock: IO[str], kind: int) -> bool:
    try:
        fcntl.flock(lock, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
