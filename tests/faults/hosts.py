"""A secured stack over two hosts: simulator and drive where the robot is, everything else on the other."""

import datetime as dt
import os
import subprocess
import sys
from contextlib import AbstractContextManager
from pathlib import Path
from types import TracebackType
from typing import Self

from shared.bus import Bus, open_bus, wait_until
from shared.certificates.holders import everyone
from shared.certificates.issuing import make
from tests.faults.slow_link import ADDRESSES, SlowLink

START_S, END_S = 90.0, 10.0
SERVICES = {"map_store": "services.map_store", "features": "services.features", "planner": "services.planner"}
ROBOT = {"simulator": "tests.faults.speedometer", "drive": "services.drive"}
SETTINGS = {
    "MAP_STORE_PORT": "0",
    "SIMULATOR_WIDTH_PX": "1024",
    "SIMULATOR_ENCODING": "jpeg",  # as in deploy/compose.robot.yml
    "OPENBLAS_NUM_THREADS": "1",
}


class TwoHosts:
    """Starts the processes and ends them.

    Args:
        folder: certificates, maps, states and logs.
        line: between the two.
    """

    def __init__(self, folder: Path, line: SlowLink) -> None:
        self._folder, self._line = folder, line
        self._endpoint = f"tls/{ADDRESSES[0]}:7447"
        self._children: list[subprocess.Popen[bytes]] = []

    @property
    def speeds_file(self) -> Path:
        """What the robot's true speed was, see `tests.faults.speedometer`."""
        return self._folder / "speeds"

    def __enter__(self) -> Self:
        make(self._folder / "certs", everyone("r1"), dt.datetime.now(dt.UTC), hosts=(ADDRESSES[0],))
        try:
            self._start("router", "shared.router")
            for holder, module in SERVICES.items():
                self._start(holder, module)
            self._start("drive", ROBOT["drive"])
            self._start("simulator", ROBOT["simulator"], str(self.speeds_file))
            with self.operator() as bus:
                for holder in SERVICES | ROBOT:
                    assert wait_until(lambda name=holder: bus.alive(name) == [name], START_S), holder
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End all processes."""
        for child in self._children:
            child.terminate()
        for child in self._children:
            try:
                child.wait(END_S)
            except subprocess.TimeoutExpired:
                child.kill()

    def operator(self) -> AbstractContextManager[Bus]:
        """A session of an operator on the services' host."""
        return open_bus(self._endpoint, certs=self._folder / "certs/operator")

    def _start(self, holder: str, module: str, *arguments: str) -> None:
        own = {
            "TOPNAV_ENDPOINT": self._endpoint,
            "TOPNAV_ROUTER_LISTEN": self._endpoint,
            "TOPNAV_CERTS": str(self._folder / "certs" / holder),
            "MAP_STORE_DATABASE_URL": f"sqlite:///{self._folder}/maps.sqlite3",
            "DRIVE_STATE_DIR": str(self._folder / "drive-state"),
            "SIMULATOR_STATE_DIR": str(self._folder / "robot-state"),
        }
        command = [sys.executable, "-m", module, *arguments]
        command = self._line.on_far_host(command) if holder in ROBOT else command
        with (self._folder / f"{holder}.jsonl").open("wb") as log:
            self._children.append(
                subprocess.Popen(command, env={**os.environ, **SETTINGS, **own}, stdout=log, stderr=log)
            )
