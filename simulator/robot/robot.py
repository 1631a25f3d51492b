"""The robot in PhysX: a chassis on the wheels of its base, and the low-level controller of their servos."""

import math

import numpy as np
import sapien

from shared.motion.motion import NO_MOTION, Motion
from simulator.disturbances.traction import FULL, Traction
from simulator.robot.articulation import WHEEL_LAG_RAD, build
from simulator.robot.steering import LegTarget, next_targets
from simulator.robot.undercarriage import rolls, undercarriage_of
from simulator.robot.wheel_odometry import rolled
from simulator.settings import RobotSettings


class Robot:
    """The articulation and its low-level controller.

    Attributes:
        odometry: the way since the robot was put down, as the encoders of its wheels say.
        odometry_per_s: how they turn now, as the motion of one second.
        links: of the articulation by name.
    """

    def __init__(
        self, scene: sapien.Scene, settings: RobotSettings, x_m: float, y_m: float, yaw_rad: float
    ) -> None:
        """Put the robot on the floor at a pose, at rest, wheels straight."""
        self._settings = settings
        self._undercarriage = undercarriage_of(settings.base)
        self._mounts = self._undercarriage.mounts
        self._articulation = build(scene, settings, x_m, y_m, yaw_rad)
        joints = {joint.name: joint for joint in self._articulation.active_joints}
        order = [joint.name for joint in self._articulation.active_joints]
        places = range(len(self._mounts))
        self._steer = {k: joints[f"steer{k}"] for k in places if self._mounts[k].steered}
        self._drive = {k: joints[f"drive{k}"] for k in places if self._mounts[k].driven}
        self._steer_index = {k: order.index(f"steer{k}") for k in self._steer}
        self._drive_index = [order.index(f"drive{k}") for k in places]
        self._targets = [LegTarget(0.0, 0.0)] * len(self._mounts)
        self._angles = [0.0] * len(self._mounts)
        self._rolls, self._traction = rolls(self._undercarriage, 0.0, 0.0, 0.0), FULL
        self._turned_rad = self._wheel_angles_rad()
        self.odometry = self.odometry_per_s = NO_MOTION
        self.links = {link.name: link for link in self._articulation.links}

    def command(
        self, forward_mps: float, left_mps: float, turn_radps: float, traction: Traction = FULL
    ) -> None:
        """Move like this, robot frame, as the wheels grip. A stop keeps the wheels where they point."""
        self._traction = traction
        self._rolls = rolls(
            self._undercarriage,
            traction.forward * forward_mps,
            traction.left * left_mps,
            traction.turn * turn_radps,
            traction.deadband_mps,
        )

    def control(self, dt_s: float) -> None:
        """Set the servo targets for the next physics step."""
        measured, steers_rad = self._articulation.qpos, self.steer_angles_rad()
        self._targets = next_targets(
            self._mounts, self._rolls, steers_rad, self._targets, dt_s, self._settings
        )
        for k, joint in self._steer.items():
            joint.set_drive_target(self._targets[k].steer_rad)
        for k, joint in self._drive.items():
            self._angles[k] = self._next_angle(k, float(measured[self._drive_index[k]]), dt_s)
            joint.set_drive_target(self._angles[k])
            joint.set_drive_velocity_target(self._targets[k].wheel_radps)

    def _next_angle(self, wheel: int, measured_rad: float, dt_s: float) -> float:
        """Angle servo: the target turns with the wanted speed, so a stopped wheel does not creep."""
        wanted = self._angles[wheel] + self._targets[wheel].wheel_radps * dt_s
        return max(measured_rad - WHEEL_LAG_RAD, min(measured_rad + WHEEL_LAG_RAD, wanted))

    def measure(self, dt_s: float) -> None:
        """Read the encoders after a physics step, and sum up how far the wheels rolled."""
        now_rad = self._wheel_angles_rad()
        ways_m = [
            mount.radius_m * (now - before)
            for mount, now, before in zip(self._mounts, now_rad, self._turned_rad, strict=True)
        ]
        self._turned_rad = now_rad
        step = self._traction.rolled(rolled(self._mounts, self.steer_angles_rad(), ways_m))
        self.odometry = self.odometry.then(step)
        self.odometry_per_s = Motion(step.x_m / dt_s, step.y_m / dt_s, step.turn_rad / dt_s)

    def _wheel_angles_rad(self) -> list[float]:
        measured = self._articulation.qpos
        return [float(measured[index]) for index in self._drive_index]

    def steer_angles_rad(self) -> list[float]:
        """Measured steer angles of the wheels; 0 for those that do not steer."""
        measured = self._articulation.qpos
        return [
            float(measured[self._steer_index[k]]) if k in self._steer_index else 0.0
            for k in range(len(self._mounts))
        ]

    def pose(self) -> tuple[float, float, float]:
        """True x, y (metres) and yaw (radians)."""
        pose = self._articulation.root_pose
        w, x, y, z = (float(v) for v in pose.q)
        return float(pose.p[0]), float(pose.p[1]), math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def motion(self) -> tuple[float, float, float]:
        """Velocity of the chassis along x and y of the world (m/s), and its turning (rad/s)."""
        x_mps, y_mps = (float(v) for v in self._articulation.root_linear_velocity[:2])
        return x_mps, y_mps, float(self._articulation.root_angular_velocity[2])

    def speed_mps(self) -> float:
        """Speed of the chassis over the floor."""
        return float(np.hypot(*self._articulation.root_linear_velocity[:2]))
