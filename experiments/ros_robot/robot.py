"""A simulated robot that only ROS reaches: simulator, its node, the guard before its base."""

import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import yaml

from experiments.ros_robot.body import NODE, RosBody
from experiments.ros_robot.truth import TruthRelay
from services.launcher.client.stack import ROBOT, Stack, StackChoice, open_stack
from services.launcher.processes.supervisor import Launcher
from services.ros.robot_file import RobotFile
from services.ros.wires.codec import Codec
from services.ros.wires.opening import Interpreter, open_wire
from shared.bus import Bus, open_bus

END_S, AGAIN_S = 10.0, 0.5
LOCAL = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
"""Nobody outside of this machine hears the robot."""
SENSES = {
    "SIMULATOR_ENCODING": "jpeg",
    "SIMULATOR_ODOMETRY": "true",
    "SIMULATOR_IMU": "true",
}
"""A CompressedImage carries JPEG; wheels have encoders, and the camera an IMU."""


@dataclass(frozen=True)
class RosRobot:
    """Where it lives.

    Attributes:
        folder: its logs, its file and its computer's state.
        world, seed: of the simulator.
        domain: ROS_DOMAIN_ID.
        python: interpreter with rclpy.
        environment: of its simulator, beside SENSES.
        camera: whether its pictures are in ROS; else topnav has a camera of its own.
    """

    folder: Path
    world: str
    seed: int
    domain: int
    python: Path
    environment: Mapping[str, str] = field(default_factory=dict)
    camera: bool = True

    @property
    def file(self) -> Path:
        """What topnav is told of it."""
        return self.folder / "robot.yaml"

    @property
    def variables(self) -> dict[str, str]:
        """Of the processes that join its ROS."""
        return {**LOCAL, "ROS2_PYTHON": str(self.python.absolute()), "ROS2_ROBOT_FILE": str(self.file)}

    def described(self) -> RobotFile:
        """Its file: as those of deploy/robots, with all that it senses."""
        return RobotFile.model_validate(
            {
                "name": "simulated robot",
                "wire": {"kind": "rclpy", "domain": self.domain},
                "camera": {"topic": "/panorama/compressed", "frame": "camera"} if self.camera else None,
                "scan": {"topic": "/scan", "frame": "laser"},
                "odometry": {"topic": "/odom"},
                "imu": {"topic": "/imu"},
                "velocity": {"topic": "/cmd_vel_unguarded"},
                "guard": {"topic": "/cmd_vel", "type": "geometry_msgs/msg/TwistStamped"},
                "limits": {"forward_mps": 1.0, "left_mps": 1.0, "turn_radps": 2.0},
            }
        )


class Guard:
    """The guard's process, started again when it ends, as the robot's own computer would."""

    def __init__(self, robot: RosRobot) -> None:
        self._robot, self._log = robot, (robot.folder / "guard.log").open("wb")
        self._end, self.popen = threading.Event(), self._start()
        self._thread = threading.Thread(target=self._keep_up, name="guard", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End it for good."""
        self._end.set()
        self._thread.join()
        self.popen.terminate()
        try:
            self.popen.wait(END_S)
        except subprocess.TimeoutExpired:
            self.popen.kill()
            self.popen.wait()
        self._log.close()

    def _start(self) -> "subprocess.Popen[bytes]":
        command = [sys.executable, "-m", "services.ros.guard"]
        environment = {**os.environ, **self._robot.variables}
        return subprocess.Popen(command, env=environment, stdout=self._log, stderr=self._log)

    def _keep_up(self) -> None:
        while not self._end.wait(AGAIN_S):
            if self.popen.poll() is not None:
                self.popen = self._start()


@dataclass(frozen=True)
class Running:
    """A robot that is up.

    Attributes:
        simulator: runs its simulator, on a bus that nobody of topnav knows.
        guard: before its base.
    """

    simulator: Launcher
    guard: Guard


@contextmanager
def running(robot: RosRobot) -> Iterator[Running]:
    """Start the robot.

    Raises:
        LaunchError: the simulator does not come up.
        WireError: ROS does not.
    """
    robot.folder.mkdir(parents=True, exist_ok=True)
    file = robot.described()
    robot.file.write_text(yaml.safe_dump(file.model_dump(mode="json")), encoding="utf-8")
    os.environ.update(LOCAL)  # of the node that this process starts
    with ExitStack() as stack:
        simulator = Launcher(
            robot.folder, robot.world, lockstep=False, seed=robot.seed,
            environment={**SENSES, **robot.environment}, only=["simulator"],
        )  # fmt: skip
        stack.enter_context(simulator)
        bus = stack.enter_context(open_bus(simulator.endpoint))
        codec, rclpy = Codec(file.wire.distribution), Interpreter(str(robot.python))
        wire = stack.enter_context(closing(open_wire(file.wire, codec, NODE, rclpy)))
        stack.enter_context(closing(RosBody(bus, ROBOT, wire, codec, file)))
        yield Running(simulator, stack.enter_context(closing(Guard(robot))))


@contextmanager
def running_stack(robot: RosRobot, choice: StackChoice) -> Iterator[Stack]:
    """Start the robot and a stack that drives it, in real time; `choice` says the rest of the stack.

    Raises:
        LaunchError: simulator or stack does not come up.
        WireError: ROS does not.
    """
    whole = replace(choice, lockstep=False, ros=str(robot.file), environment=robot.variables)
    with running(robot) as up, open_stack(whole) as stack, judged(up, stack.bus):
        yield stack


@contextmanager
def judged(robot: Running, stack: Bus) -> Iterator[None]:
    """Let the experimenter of a stack reach the simulator, past ROS."""
    with open_bus(robot.simulator.endpoint) as bus, closing(TruthRelay(bus, stack, ROBOT)):
        yield
