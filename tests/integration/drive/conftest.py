"""A drive process on a bus of its own, and the planner and robot it talks to."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

import pytest

from shared.bus import Bus, open_bus, wait_until
from shared.messages.drive import Heading, Velocity
from shared.messages.estop import EStopRequest, EStopState
from shared.messages.sensors import Ranges
from shared.topics import ESTOP, ESTOP_STATE, HEADING, RANGES, ROBOT_ESTOP_STATE, VELOCITY

START_S, SOON_S = 60.0, 30.0
"""Long enough where other processes take most of the machine, and may stop ours for seconds."""


class Neighbours:
    """Planner, robot and person in one session."""

    def __init__(self, bus: Bus) -> None:
        self.bus = bus
        self._headings, self._ranges = bus.publisher(HEADING, robot="r1"), bus.publisher(RANGES, robot="r1")
        self.robot_estop = bus.publisher(ROBOT_ESTOP_STATE, robot="r1")
        self._commands = bus.subscribe(VELOCITY, robot="r1")
        self.newest: Velocity | None = None
        self._frames = count(1)
        self.estop_states = bus.subscribe(ESTOP_STATE, robot="r1")

    def frame(self) -> int:
        """Number of the next frame: an answer to the same one again and again soon is one to an old one."""
        return next(self._frames)

    def see(self, seq: int, *, stamp_ns: int = 0, lockstep: bool = False, near_m: float = 4.0) -> None:
        """Distances of frame `seq`, measured now unless a time is given; nothing is near unless told."""
        angles = tuple(k * 0.5 for k in range(12))
        self._ranges.put(
            Ranges(
                seq=seq, stamp_ns=stamp_ns or time.time_ns(), robot="r1", lockstep=lockstep,
                angles_rad=angles, distances_m=(near_m,) * 12, max_range_m=4.0,
            )
        )  # fmt: skip

    def wish(
        self, seq: int, *, stamp_ns: int = 0, epoch: int = 1, age_s: float = 0.0, heading_rad: float = 0.5
    ) -> None:
        """A heading from frame `seq`, taken `age_s` ago."""
        self._headings.put(
            Heading(
                seq=seq, stamp_ns=stamp_ns or time.time_ns() - int(age_s * 1e9), robot="r1", epoch=epoch,
                heading_rad=heading_rad,
            )
        )  # fmt: skip

    def commands(
        self,
        during_s: float,
        act: Callable[[], None] = lambda: None,
        until: Callable[[list[Velocity]], bool] = lambda _: True,
    ) -> list[Velocity]:
        """All commands of a while in which `act` is done again and again; it goes on until `until` holds."""
        began_s, came = time.monotonic(), []
        while (gone_s := time.monotonic() - began_s) < during_s or (not until(came) and gone_s < SOON_S):
            act()
            time.sleep(0.03)
            came += self._commands.take_all()
            self.newest = came[-1] if came else self.newest
        return came

    def drives(self, act: Callable[[], None]) -> bool:
        """Whether `act`, repeated, makes drive turn the wheels."""
        return wait_until(lambda: any(c.speed_mps for c in self.commands(0.1, act)), SOON_S)

    def estop(self, action: str, who: str = "", why: str = "") -> EStopState:
        return self.bus.ask(ESTOP, EStopRequest(action=action, who=who, why=why), SOON_S, robot="r1")


@pytest.fixture(scope="module", autouse=True)
def _patient(patient_sessions: None) -> None:
    """All sessions but that of drive are in this process, and stand still with it."""


@pytest.fixture
def neighbours(router_endpoint: str) -> Iterator[Neighbours]:
    with open_bus(router_endpoint) as bus:
        yield Neighbours(bus)


@pytest.fixture
def start(router_endpoint: str, tmp_path: Path, neighbours: Neighbours) -> Iterator[Callable[[], object]]:
    """Start a drive process with the same state folder each time; returns it once it is alive."""
    processes: list[subprocess.Popen[bytes]] = []

    def launch() -> subprocess.Popen[bytes]:
        state = {"TOPNAV_ENDPOINT": router_endpoint, "DRIVE_STATE_DIR": str(tmp_path / "state")}
        before = sum(process.poll() is None for process in processes)
        assert wait_until(lambda: len(neighbours.bus.alive("drive")) == before, START_S), (
            "a killed one is gone"
        )
        processes.append(subprocess.Popen([sys.executable, "-m", "services.drive"], env=os.environ | state))
        assert wait_until(lambda: len(neighbours.bus.alive("drive")) == before + 1, START_S)
        return processes[-1]

    yield launch
    for process in processes:
        process.kill()
        process.wait()
