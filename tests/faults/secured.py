"""A secured bus of real processes: router with access rules, map store, drive; and sessions on it."""

import datetime as dt
import os
import subprocess
import sys
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Self

from shared.bus import Bus, UnreachableError, open_bus, wait_until
from shared.certificates.holders import everyone
from shared.certificates.issuing import make

START_S = 60.0


class SecuredBus:
    """Starts what it is asked for and ends all of it.

    Args:
        folder: certificates, states and maps live here.
        repository: where the processes run.
        port: of the router.
        rest_port: of the map store.
        robots: that the router knows, separated by commas.
    """

    def __init__(self, folder: Path, repository: Path, port: int, rest_port: int, robots: str = "r1") -> None:
        self.certs, self.endpoint = folder / "certs", f"tls/127.0.0.1:{port}"
        self.rest_url = f"https://127.0.0.1:{rest_port}"
        self._folder, self._repository, self._rest_port = folder, repository, rest_port
        self._robots = robots
        self._stack, self._buses = ExitStack(), dict[str, Bus]()
        self._children: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Self:
        make(self.certs, everyone("r1"), dt.datetime.now(dt.UTC))
        listen = {"TOPNAV_ROUTER_LISTEN": self.endpoint, "TOPNAV_ROBOTS": self._robots}
        try:
            self.start("router", "shared.router", listen)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End all sessions and processes."""
        self._stack.close()
        for child in reversed(self._children):
            child.kill()
            child.wait()

    def start(self, holder: str, module: str, environment: Mapping[str, str] | None = None) -> None:
        """Start a service with its own certificate and wait until it is alive."""
        own = {"TOPNAV_ENDPOINT": self.endpoint, "TOPNAV_CERTS": str(self.certs / holder)}
        variables = {**os.environ, **own, **(environment or {})}
        command = [sys.executable, "-m", "tests.patient", module]
        self._children.append(subprocess.Popen(command, cwd=self._repository, env=variables))
        assert wait_until(lambda: self._alive(holder), START_S), holder

    def _alive(self, holder: str) -> bool:
        try:
            return self.bus("operator").alive(holder) == [holder]
        except UnreachableError:  # the router, the first to be started, is not up yet
            return False

    def start_map_store(self) -> None:
        """The map store, with REST for those who may write."""
        url = f"sqlite:///{self._folder}/maps.sqlite3"
        store = {"MAP_STORE_PORT": str(self._rest_port), "MAP_STORE_DATABASE_URL": url}
        self.start("map_store", "services.map_store", store)

    def start_drive(self) -> None:
        """The drive service of robot r1."""
        self.start("drive", "services.drive", {"DRIVE_STATE_DIR": str(self._folder / "drive-state")})

    def bus(self, holder: str) -> Bus:
        """A session with this holder's certificate, as who stole it would open one."""
        if holder not in self._buses:
            opened = open_bus(self.endpoint, certs=self.certs / holder)
            self._buses[holder] = self._stack.enter_context(opened)
        return self._buses[holder]
