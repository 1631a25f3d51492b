"""Simulation state -> bus messages."""

import math
import time

import cv2
import numpy as np

from shared.messages.body import Odometry
from shared.messages.sensors import Frame, Ranges
from shared.messages.simulation import Pose, Truth
from simulator.scene.parts import Pose2
from simulator.sensors.attitude import Vector
from simulator.service_settings import SimulatorSettings
from simulator.simulation import Image, Simulation


class MessageMaker:
    """Turns what the simulation measures into messages of one robot."""

    def __init__(self, simulation: Simulation, settings: SimulatorSettings) -> None:
        self._simulation, self._settings = simulation, settings
        self._render_ms = 0.0

    def ranges(self, seq: int, stamp_ns: int) -> Ranges:
        """A fresh reading of the distance sensors."""
        return Ranges(
            seq=seq, stamp_ns=stamp_ns, robot=self._settings.robot, lockstep=self._settings.lockstep,
            angles_rad=tuple(self._simulation.range_angles_rad().tolist()),
            distances_m=tuple(self._simulation.ranges().tolist()),
            max_range_m=self._settings.range_max_m,
            step_s=self._settings.control_period_s if self._settings.lockstep else None,
        )  # fmt: skip

    def frame(self, seq: int, stamp_ns: int) -> Frame:
        """What the robot sees."""
        started_s = time.perf_counter()
        picture = self._simulation.panorama()
        self._render_ms = 1000.0 * (time.perf_counter() - started_s)
        return self._message(picture, self._simulation.gravity(), seq, stamp_ns)

    def look(self, pose: Pose2, seq: int, stamp_ns: int) -> Frame:
        """What a camera at rest sees from any pose."""
        picture = self._simulation.panorama_at(*pose)
        return self._message(picture, self._simulation.gravity_at(*pose), seq, stamp_ns)

    def _message(self, picture: Image, gravity: Vector | None, seq: int, stamp_ns: int) -> Frame:
        if self._settings.encoding == "jpeg":
            _, coded = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, self._settings.jpeg_quality])
            data = coded.tobytes()
        else:
            data = np.ascontiguousarray(picture).tobytes()
        height, width = picture.shape[:2]
        return Frame(
            seq=seq, stamp_ns=stamp_ns, robot=self._settings.robot, lockstep=self._settings.lockstep,
            encoding=self._settings.encoding, width_px=width, height_px=height, data=data,
            gravity=gravity,
        )  # fmt: skip

    def odometry(self, seq: int, stamp_ns: int) -> Odometry:
        """Where the wheels say that the robot has got to, and how they turn now."""
        way, rate = self._simulation.odometry()
        return Odometry(
            seq=seq, stamp_ns=stamp_ns, robot=self._settings.robot,
            x_m=way.x_m, y_m=way.y_m, yaw_rad=math.remainder(way.turn_rad, math.tau),
            forward_mps=rate.x_m, left_mps=rate.y_m, turn_radps=rate.turn_rad,
        )  # fmt: skip

    def truth(self, seq: int, stamp_ns: int) -> Truth:
        """The true state; only the evaluation reads it."""
        true = self._simulation.truth()
        hider = (
            None if true.hider is None else Pose(x_m=true.hider[0], y_m=true.hider[1], yaw_rad=true.hider[2])
        )
        return Truth(
            seq=seq, stamp_ns=stamp_ns, robot=self._settings.robot, world=self._simulation.world.name,
            pose=Pose(x_m=true.x_m, y_m=true.y_m, yaw_rad=true.yaw_rad), hider=hider, sim_time_s=true.time_s,
            speed_mps=true.speed_mps, collisions=true.collisions, render_ms=self._render_ms,
        )  # fmt: skip
