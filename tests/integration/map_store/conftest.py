"""The map store as a process, which tests may kill."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from services.launcher.processes.free_ports import is_free
from shared.bus import Bus, open_bus, wait_until

START_S = 60.0
"""To start or to end, on a machine where all may stand still for seconds; elsewhere two are enough."""


class Process:
    """A map store on a database of its own, or that of `database_url`; `start` it as often as it was killed.

    `inside` is a command that runs another one, for example in a namespace with a disk of its own. One that
    is `patient` is not given up for standing still, where this process has `patient_sessions`.
    """

    def __init__(
        self,
        repository: Path,
        folder: Path,
        endpoint: str,
        port: int,
        inside: Sequence[str] = (),
        listen: str = "tcp/127.0.0.1:0",
        database_url: str = "",
        patient: bool = False,
    ) -> None:
        module = [*(["tests.patient"] if patient else []), "services.map_store"]
        self._repository, self._command = repository, [*inside, sys.executable, "-m", *module]
        self._environment = os.environ | {
            "TOPNAV_ENDPOINT": endpoint,
            "TOPNAV_LISTEN": listen,
            "MAP_STORE_PORT": str(port),
            "MAP_STORE_DATABASE_URL": database_url or f"sqlite:///{folder}/maps.sqlite3",
        }
        self._port = port
        self.url = f"http://127.0.0.1:{port}"
        self.child: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start the process."""
        self.child = subprocess.Popen(self._command, cwd=self._repository, env=self._environment)

    def kill(self) -> None:
        """End it without a chance to clean up; its port is free again then."""
        assert self.child is not None
        self.child.kill()
        self.child.wait(START_S)
        assert wait_until(lambda: is_free(self._port), START_S), f"somebody else listens on port {self._port}"


@pytest.fixture(scope="module", autouse=True)
def _patient(patient_sessions: None) -> None:
    """Nobody is given up for standing still."""


@pytest.fixture
def process(
    repository: Path,
    tmp_path: Path,
    patient_sessions: None,  # noqa: ARG001
    router_endpoint: str,
    free_port: Callable[[], int],
) -> Iterator[Process]:
    """A map store that was started and is stopped at the end whatever happens."""
    process = Process(repository, tmp_path, router_endpoint, free_port(), patient=True)
    process.start()
    yield process
    if process.child is not None and process.child.poll() is None:
        process.kill()


@pytest.fixture
def bus(router_endpoint: str, process: Process) -> Iterator[Bus]:
    """A peer that sees the running map store."""
    with open_bus(router_endpoint) as opened:
        assert wait_until(lambda: opened.alive("map_store") != [], START_S), process
        yield opened
