"""A simulated TurtleBot 4 with a THETA: base and scanner in ROS 2, pictures over HTTP, 0.4 s late."""

import os
import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from experiments.ros_robot.robot import RosRobot, Running, judged, running
from services.launcher.client.stack import Stack, StackChoice, open_stack
from shared.bus import open_bus, wait_until
from shared.topics import FRAME
from tests.integration.ros.conftest import ROS_PYTHON
from tests.osc_camera import OscCamera

WORLD = "apartment"
DELAY_S, RATE_HZ = 0.4, 5.0
"""Of a THETA's preview over wifi (deploy/CAMERAS.md)."""
FIRST_PICTURE_S = 60.0
IN_ROS = [
    pytest.mark.render,
    pytest.mark.slow,
    pytest.mark.usefixtures("patient_sessions"),
    pytest.mark.skipif(not ROS_PYTHON.exists(), reason=f"no {ROS_PYTHON}: deploy/setup/ros.sh makes it"),
]
"""Marks of tests whose robot is in ROS."""


@dataclass
class Eye:
    """The camera's sensor: what the simulator shows."""

    endpoint: str
    seen: deque[tuple[float, bytes]] = field(default_factory=lambda: deque(maxlen=20))
    end: threading.Event = field(default_factory=threading.Event)

    def look(self) -> None:
        """Keep what is shown until the end."""
        with open_bus(self.endpoint) as bus:
            frames = bus.subscribe(FRAME, robot="r1")
            while not self.end.is_set():
                bus.wait(0.05)
                if (frame := frames.take()) is not None:
                    self.seen.append((time.monotonic(), frame.data))

    def picture(self, at_s: float) -> bytes:
        """The JPEG that was exposed at a time or just before."""
        assert wait_until(lambda: bool(self.seen), FIRST_PICTURE_S)
        before = [data for came_s, data in tuple(self.seen) if came_s <= at_s]
        return before[-1] if before else self.seen[0][1]


@dataclass
class ThetaRobot:
    """A robot, its stack and its camera."""

    stack: Stack
    body: Running
    camera: OscCamera


def domain() -> int:
    """A ROS domain that no other worker of this run uses (below 180: tests/integration/ros)."""
    return 180 + int(os.environ.get("PYTEST_XDIST_WORKER", "gw40").removeprefix("gw"))


@contextmanager
def theta_robot(folder: Path, width_px: int, ranges_hz: int = 10) -> Iterator[ThetaRobot]:
    """Start all of it, in real time."""
    senses = {
        "SIMULATOR_WIDTH_PX": str(width_px),
        "SIMULATOR_FRAME_RATE_HZ": "8",
        "SIMULATOR_RANGE_RATE_HZ": str(ranges_hz),
    }
    robot = RosRobot(folder / "robot", WORLD, 1, domain(), ROS_PYTHON, senses, camera=False)
    with running(robot) as body:
        eye = Eye(body.simulator.endpoint)
        looking = threading.Thread(target=eye.look)
        looking.start()
        try:
            with OscCamera(eye.picture, RATE_HZ, DELAY_S) as camera:
                choice = StackChoice(
                    folder / "data", lockstep=False, seed=1, ros=str(robot.file), camera=camera.url,
                    environment=robot.variables,
                )  # fmt: skip
                with open_stack(choice) as stack, judged(body, stack.bus):
                    yield ThetaRobot(stack, body, camera)
        finally:
            eye.end.set()
            looking.join()
