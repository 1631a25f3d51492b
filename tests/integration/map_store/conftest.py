"""The map store as a process, which tests may kill."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from shared.bus import Bus, open_bus, wait_until

START_S = 30.0


class Process:
    """A map store on a database of its own, or that of `database_url`; `start` it as often as it was killed.

    `inside` is a command that runs another one, for example in a namespace with a disk of its own.
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
    ) -> None:
        self._repository, self._inside = repository, inside
        self._environment = os.environ | {
            "TOPNAV_ENDPOINT": endpoint,
            "TOPNAV_LISTEN": listen,
            "MAP_STORE_PORT": str(port),
            "MAP_STORE_DATABASE_URL": database_url or f"sqlite:///{folder}/maps.sqlite3",
        }
        self.url = f"http://127.0.0.1:{port}"
        self.child: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start the process."""
        command = [*self._inside, sys.executable, "-m", "services.map_store"]
        self.child = subprocess.Popen(command, cwd=self._repository, env=self._environment)

    def kill(self) -> None:
        """End it without a chance to clean up."""
        assert self.child is not None
        self.child.kill()
        self.child.wait(10)


@pytest.fixture
def process(
    repository: Path, tmp_path: Path, router_endpoint: str, free_port: Callable[[], int]
) -> Iterator[Process]:
    """A map store that was started and is stopped at the end whatever happens."""
    process = Process(repository, tmp_path, router_endpoint, free_port())
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
