"""ROS loop: what the robot senses to topnav, topnav's velocities to the base, missions for ROS."""

import logging
import threading
import time
from typing import Any

from services.ros.base_link import BaseLink
from services.ros.conversions.twist import STAND
from services.ros.driving import Driving
from services.ros.missions import MissionDesk
from services.ros.repeating import Repeating
from services.ros.robot_file import RobotFile
from services.ros.sensing import Sensing
from services.ros.settings import RosSettings
from services.ros.wires.codec import Codec
from services.ros.wires.opening import wait_for_wire
from services.ros.wires.wire import NODE, Wire
from shared.bus import Bus, Publisher
from shared.estop.sides import RobotEStop
from shared.messages.base import Message
from shared.messages.body import Battery, Imu, Odometry
from shared.messages.sensors import Frame, Ranges
from shared.sole_robot import SoleRobot
from shared.topics import BATTERY, FRAME, IMU, ODOMETRY, RANGES, STATUS, VELOCITY

log = logging.getLogger(__name__)

STEP_S = 0.02
"""Longest wait between two steps; chosen: velocities go out every 0.05 s."""
SUSPENDED_S = 0.5
BACKLOG_S = 0.2
"""A loop that stood still for so long throws away what arrives within the next 0.2 s, as drive does
(inputs.py)."""
GRAPH_S = 0.5
"""Between two looks at who publishes and subscribes; chosen."""


class RosRobot:
    """The robot on topnav's bus; its body is in ROS."""

    def __init__(self, settings: RosSettings, file: RobotFile, bus: Bus, wire: Wire, codec: Codec) -> None:
        self._bus, self._wire, robot = bus, wire, settings.robot
        self._count = bus.counters.count
        now_s = time.monotonic()
        self._sensing = Sensing(file, codec, robot, self._count, now_s, time.time_ns())
        self._driving = Driving(file.limits.motion)
        self._base, self._repeating = BaseLink(wire, codec, file.velocity), Repeating()
        self._velocities = bus.subscribe(VELOCITY, robot=robot)
        self._statuses = bus.subscribe(STATUS, robot=robot)
        self._frames = None if file.camera else bus.subscribe(FRAME, robot=robot)
        self._publishers: dict[type[Message], Publisher[Any]] = {
            Frame: bus.publisher(FRAME, robot=robot),
            Ranges: bus.publisher(RANGES, robot=robot),
            Odometry: bus.publisher(ODOMETRY, robot=robot),
            Imu: bus.publisher(IMU, robot=robot),
            Battery: bus.publisher(BATTERY, robot=robot),
        }
        self._estop = RobotEStop(bus, robot, settings.state_dir)
        self._asked_to_stand = threading.Event()
        self._desk = MissionDesk(bus, codec, robot, self._stand) if file.missions else None
        self._last_s, self._looked_s, self._problem = now_s, 0.0, ""
        self._sensing.subscribe(wire, bus.wake)
        if self._desk is not None and file.missions is not None:
            self._desk.open(wire, file.missions)

    def step(self, now_s: float) -> None:
        """Read what came and say what follows from it.

        Raises:
            WireError: the robot's side of ROS is gone.
        """
        self._wire.require_up()
        since_s, self._last_s = self._last_s, now_s
        if now_s - since_s > SUSPENDED_S:
            log.warning("suspended for %.1f s: what came meanwhile is thrown away", now_s - since_s)
            self._sensing.ignore(now_s + BACKLOG_S)
            self._velocities.take_all()
            self._driving.forget()
        for message in self._sensing.take(now_s):
            self._pass_on(message, now_s)
        self._follow_frames(now_s)
        self._drive(since_s, now_s)
        self._estop.tell(now_s)
        if self._desk is not None:
            for status in self._statuses.take_all():
                self._desk.tell(status, now_s)

    def close(self) -> None:
        """Leave the base with a word to stand."""
        self._base.send(STAND, self._sensing.robot_time_s(time.monotonic()))
        if self._desk is not None:
            self._desk.close()

    def _pass_on(self, message: Message, now_s: float) -> None:
        self._publishers[type(message)].put(message)
        if isinstance(message, Frame):
            self._driving.frame_out(message.seq, now_s)

    def _follow_frames(self, now_s: float) -> None:
        """Without a camera in ROS frames are of topnav's own: distances carry the number of the newest."""
        frame = self._frames.take() if self._frames is not None else None
        if frame is not None:
            self._sensing.seq = frame.seq
            self._driving.frame_out(frame.seq, now_s)

    def _drive(self, since_s: float, now_s: float) -> None:
        velocity = self._velocities.take()
        if velocity is not None:
            refused = self._driving.hear(velocity, since_s, now_s)
            if refused:
                self._count("refused", refused)
        if now_s - self._looked_s > GRAPH_S:
            self._looked_s, self._problem = now_s, self._base.problem()
            self._sensing.tell_silence(self._wire, now_s)
        engaged = self._estop.engaged()
        if engaged:
            self._asked_to_stand.clear()  # the stop that was asked for holds by itself now
        problem = self._problem or self._sensing.problem(now_s)
        hold = engaged or self._asked_to_stand.is_set() or problem != ""
        motion = self._driving.wanted(now_s, hold)
        if problem and not self._driving.wanted(now_s, hold=False).stands:
            self._count("stands", f"the robot stands: {problem}")
        if self._repeating.due(motion, now_s):
            self._base.send(motion, self._sensing.robot_time_s(now_s))

    def _stand(self) -> None:
        """Called on a thread of the wire."""
        self._asked_to_stand.set()
        self._bus.wake.set()


def run(settings: RosSettings, file: RobotFile, bus: Bus, stop: threading.Event) -> None:
    """Serve until `stop`.

    Raises:
        TakenError: another process is this robot.
        WireError: the robot's side of ROS ended.
    """
    sole = SoleRobot(bus, settings.robot)
    codec = Codec(file.wire.distribution)
    wire = wait_for_wire(file.wire, codec, NODE, settings.interpreter, stop)
    if wire is None:
        return
    try:
        sole.claim()
        robot = RosRobot(settings, file, bus, wire, codec)
        bus.announce("ros")
        log.info("%s over %s", file.name, file.wire.kind)
        try:
            while not stop.is_set():
                bus.wait(STEP_S)
                sole.require()
                robot.step(time.monotonic())
        finally:
            robot.close()
    finally:
        wire.close()
