"""The robot's computer: what the simulator senses to ROS, the base's velocities to the simulator."""

import threading
import time
from typing import Any

from experiments.ros_robot.messages import PICTURE, imu_of, odometry_of, picture_of, scan_of
from services.ros.conversions.header import ConversionError
from services.ros.conversions.twist import Motion, motion_of
from services.ros.robot_file import RobotFile
from services.ros.sensing import IMU, ODOMETRY, SCAN
from services.ros.wires.codec import Codec, CodecError
from services.ros.wires.wire import SENSOR, URGENT, Put, Wire
from shared.bus import Bus
from shared.messages.drive import Velocity
from shared.topics import FRAME, RANGES, VELOCITY
from shared.topics import ODOMETRY as ODOMETRY_TOPIC

NODE = "simulated_robot"
PERIOD_S = 0.02
"""Longest wait between two steps; chosen: velocities come every 0.05 s."""
TIME_OUT_MS = 300
"""The base stands so long after the last velocity; chosen: half a second is usual."""


class RosBody:
    """One robot: a simulator on a bus of its own, and a node of ROS.

    Args:
        bus: the simulator's.
        robot: its name there.
        wire: the node.
        codec: of its ROS.
        file: names the topics, as topnav is told them.
    """

    def __init__(self, bus: Bus, robot: str, wire: Wire, codec: Codec, file: RobotFile) -> None:
        self._bus, self._robot, self._codec = bus, robot, codec
        self._frames = bus.subscribe(FRAME, robot=robot)
        self._ranges = bus.subscribe(RANGES, robot=robot)
        self._odometry = bus.subscribe(ODOMETRY_TOPIC, robot=robot)
        self._velocities = bus.publisher(VELOCITY, robot=robot)
        self._put: dict[str, Put] = {}
        for kind, topic in (
            (PICTURE, file.camera),
            (SCAN, file.scan),
            (ODOMETRY, file.odometry),
            (IMU, file.imu),
        ):
            if topic is not None:
                self._put[kind] = wire.publisher(topic.topic, kind, SENSOR)
        self._lock, self._seq = threading.Lock(), 0
        self._heard: Motion | None = None
        base = file.guard or file.velocity
        self._hears = base.types()[0]
        wire.subscribe(base.topic, self._hears, self._store, URGENT)
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, name=NODE, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Carry no more."""
        self._end.set()
        self._thread.join()

    def _store(self, payload: bytes, _came_s: float) -> None:
        """Called on a thread of the wire."""
        try:
            motion = motion_of(self._codec.decode(self._hears, payload), self._hears)
        except (CodecError, ConversionError):
            return
        with self._lock:
            self._heard = motion
        self._bus.wake.set()

    def _run(self) -> None:
        while not self._end.is_set():
            self._bus.wait(PERIOD_S)
            self._sense()
            self._move()

    def _sense(self) -> None:
        for odometry in self._odometry.take_all():
            self._say(ODOMETRY, odometry_of(self._codec, odometry))
        ranges, frame = self._ranges.take(), self._frames.take()
        if ranges is not None:
            self._say(SCAN, scan_of(self._codec, ranges))
        if frame is not None:
            self._seq = frame.seq
            if frame.gravity is not None:
                self._say(IMU, imu_of(self._codec, frame.stamp_ns, frame.gravity))
            self._say(PICTURE, picture_of(self._codec, frame))

    def _say(self, kind: str, message: Any) -> None:
        if kind in self._put:
            self._put[kind](self._codec.encode(kind, message))

    def _move(self) -> None:
        """Tell the simulator what the base was told; it stands by itself once nothing comes any more."""
        with self._lock:
            motion, self._heard = self._heard, None
        if motion is not None:
            self._velocities.put(
                Velocity(
                    seq=self._seq, stamp_ns=time.time_ns(), robot=self._robot, ttl_ms=TIME_OUT_MS,
                    forward_mps=motion.forward_mps, left_mps=motion.left_mps, turn_radps=motion.turn_radps,
                )
            )  # fmt: skip
