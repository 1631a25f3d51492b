"""Robots that work side by side in one stack, for end-to-end tests of a fleet."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from services.launcher.client.experimenter import Experimenter
from services.launcher.client.mission import MissionClient, MissionRun
from services.launcher.client.stack import Stack
from shared.bus import Inbox, wait_until
from shared.messages.missions import Event, MissionRequest
from shared.topics import EVENT

SCRIPT = Path(__file__).resolve().parents[2] / "deploy" / "examples" / "another_robot.sh"
SERVICES = ("simulator", "planner", "drive")
START_S = 120.0


@dataclass
class Robot:
    """One of them: its missions, its true way, and the places that it says it made."""

    stack: Stack
    client: MissionClient
    experimenter: Experimenter
    events: Inbox[Event]
    runs: list[MissionRun] = field(default_factory=list)

    def run(self, **request: Any) -> MissionRun:
        """One mission, to its end."""
        self.runs.append(self.client.run(MissionRequest(seed=1, **request)))
        return self.runs[-1]

    def made(self) -> list[int]:
        """Places it has told of since the last call."""
        told = [event for event in self.events.take_all() if event.kind == "node_added"]
        return [int(v.value) for event in told for v in event.values if v.name == "node"]


@contextmanager
def taking_part(stack: Stack, name: str) -> Iterator[Robot]:
    """Take part as the experimenter of one robot."""
    with replace(stack, robot=name).session() as own:
        yield Robot(
            own,
            MissionClient(own.bus, name),
            Experimenter(own.bus, name),
            own.bus.subscribe(EVENT, robot=name),
        )


@contextmanager
def another_robot(stack: Stack, name: str, world: str, folder: Path, company: str = "") -> Iterator[None]:
    """One more robot beside a running stack in lockstep, as the example starts it; it sees its company."""
    variables = {
        "PYTHON": sys.executable,
        "TOPNAV_ENDPOINT": stack.endpoint,
        "TOPNAV_DATA_DIR": str(folder),
        "SIMULATOR_WORLD": world,
        "SIMULATOR_LOCKSTEP": "true",
        "SIMULATOR_SEED": "2",
        "SIMULATOR_COMPANY": company,
    }
    before = {each: len(stack.bus.alive(each)) for each in SERVICES}

    def is_there() -> bool:
        return all(len(stack.bus.alive(each)) > count for each, count in before.items())

    with (folder / f"{name}.log").open("wb") as log:
        robot = subprocess.Popen([SCRIPT, name], env=os.environ | variables, stderr=log)
        try:
            assert wait_until(is_there, START_S, 0.2)
            yield
        finally:
            robot.terminate()
            robot.wait()


@contextmanager
def fleet_service(stack: Stack, folder: Path) -> Iterator[None]:
    """The fleet service of a running stack."""
    with _service(stack, folder, "fleet"):
        yield


@contextmanager
def dispatch_of_the_first(stack: Stack, folder: Path) -> Iterator[None]:
    """The dispatch of the robot of a stack that was opened for commands, which has none."""
    with _service(stack, folder, "dispatch", TOPNAV_ROBOT=stack.robot):
        yield


@contextmanager
def _service(stack: Stack, folder: Path, name: str, **variables: str) -> Iterator[None]:
    with (folder / f"{name}.log").open("wb") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", f"services.{name}"],
            env=os.environ | {"TOPNAV_ENDPOINT": stack.endpoint} | variables,
            stderr=log,
        )
        try:
            assert wait_until(lambda: bool(stack.bus.alive(name)), START_S, 0.2)
            yield
        finally:
            process.terminate()
            process.wait()
