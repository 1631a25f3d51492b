"""The ROS service and the robot that it speaks to, over each wire."""

import itertools
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from services.ros.conversions.twist import Motion, motion_of
from services.ros.robot_file import WireChoice
from services.ros.wires.opening import Interpreter, open_wire
from services.ros.wires.wire import Wire
from shared.bus import Bus, open_bus, wait_until
from tests.ros_messages import CODEC, ODOMETRY, PICTURE, SCAN, jpeg, odometry, scan, stamped

SOON_S = 30.0
REPOSITORY = Path(__file__).resolve().parents[3]
ROS_PYTHON = Path(os.environ.get("TOPNAV_ROS_PYTHON", REPOSITORY / ".venv-ros/bin/python"))
KINDS = ["rmw_zenoh", "bridge", "rclpy"]
DOMAINS = itertools.count(20 + os.getpid() % 100)
CLOCK_AHEAD_S = 4_000.0


@pytest.fixture(params=KINDS)
def choice(
    request: pytest.FixtureRequest, router_endpoint: str, monkeypatch: pytest.MonkeyPatch
) -> WireChoice:
    """A way to reach a robot; rclpy is skipped where there is none."""
    if request.param == "rclpy" and not ROS_PYTHON.exists():
        pytest.skip(f"no {ROS_PYTHON}: deploy/setup/ros.sh makes it, TOPNAV_ROS_PYTHON names another one")
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    return WireChoice(kind=request.param, endpoint=router_endpoint, domain=next(DOMAINS) % 232)


@pytest.fixture
def join(choice: WireChoice) -> Iterator[Callable[[str], Wire]]:
    """Join the graph as a node of a name; what is joined is left at the end."""
    with ExitStack() as stack:

        def joined(node: str) -> Wire:
            wire = open_wire(choice, CODEC, node, Interpreter(str(ROS_PYTHON)))
            stack.callback(wire.close)
            return wire

        yield joined


class Robot:
    """A robot in ROS: says what it senses ten times a second, and keeps what it is told."""

    def __init__(self, wire: Wire, hears: str, topic: str = "/cmd_vel") -> None:
        self.wire, self.ranges_m, self.senses = wire, np.full(360, 3.0), True
        self.heard: list[tuple[Motion, float, Any]] = []
        self._says = {
            SCAN: wire.publisher("/scan", SCAN),
            ODOMETRY: wire.publisher("/odom", ODOMETRY),
            PICTURE: wire.publisher("/picture", PICTURE),
        }
        wire.subscribe(topic, hears, lambda payload, at_s: self._hear(hears, payload, at_s))
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def close(self) -> None:
        """Sense no more."""
        self._end.set()
        self._thread.join()

    @property
    def motion(self) -> Motion | None:
        """What it was told last."""
        return self.heard[-1][0] if self.heard else None

    def is_told(self, motion: Motion) -> bool:
        """Whether it is told so within a while."""
        return wait_until(lambda: self.motion == motion, SOON_S)

    def _hear(self, kind: str, payload: bytes, at_s: float) -> None:
        message = CODEC.decode(kind, payload)
        self.heard.append((motion_of(message, kind), at_s, message))

    def _run(self) -> None:
        picture = np.frombuffer(jpeg(), np.uint8)
        while not self._end.wait(0.1):
            at_s = time.monotonic() + CLOCK_AHEAD_S
            shown = stamped(PICTURE, at_s)
            shown.data = picture
            said = {SCAN: scan(self.ranges_m, at_s), ODOMETRY: odometry(at_s=at_s), PICTURE: shown}
            for kind, message in said.items():
                if self.senses:
                    self._says[kind](CODEC.encode(kind, message))


@pytest.fixture
def robot(join: Callable[[str], Wire]) -> Iterator[Callable[..., Robot]]:
    """Call it with the type that the base hears."""
    with ExitStack() as stack:

        def made(hears: str, topic: str = "/cmd_vel") -> Robot:
            found = Robot(join("robot"), hears, topic)
            stack.callback(found.close)
            return found

        yield made


class Process:
    """A process of topnav and what it said."""

    def __init__(self, module: str, environment: dict[str, str], log: Path) -> None:
        self._log = log
        with log.open("wb") as file:
            self.popen = subprocess.Popen(
                [sys.executable, "-m", module], env=os.environ | environment, stdout=file, stderr=file
            )

    def says(self, text: str) -> bool:
        """Whether it says so within a while."""
        return wait_until(lambda: text in self.log, SOON_S)

    @property
    def log(self) -> str:
        """Everything it said."""
        return self._log.read_text(encoding="utf-8")


@pytest.fixture
def start(choice: WireChoice, tmp_path: Path, router_endpoint: str) -> Iterator[Callable[..., Process]]:
    """Start a module with a robot's file; changes replace its sections."""
    processes = []

    def launch(module: str, **changes: Any) -> Process:
        described = {
            "name": "test", "wire": choice.model_dump(), "scan": {"topic": "/scan"},
            "odometry": {"topic": "/odom"}, "camera": {"topic": "/picture"},
            "velocity": {"topic": "/cmd_vel"},
            "limits": {"forward_mps": 0.5, "left_mps": 0.5, "turn_radps": 2.0},
        }  # fmt: skip
        path = tmp_path / f"robot-{len(processes)}.yaml"
        path.write_text(yaml.safe_dump({**described, **changes}), encoding="utf-8")
        environment = {
            "TOPNAV_ENDPOINT": router_endpoint, "ROS2_ROBOT_FILE": str(path),
            "ROS2_PYTHON": str(ROS_PYTHON), "ROS2_STATE_DIR": str(tmp_path / "state"),
        }  # fmt: skip
        processes.append(Process(module, environment, tmp_path / f"{module}-{len(processes)}.log"))
        return processes[-1]

    yield launch
    for process in processes:
        process.popen.kill()
        process.popen.wait()


@pytest.fixture
def bus(router_endpoint: str) -> Iterator[Bus]:
    """Topnav's side."""
    with open_bus(router_endpoint) as opened:
        yield opened
