"""How the camera sits on the robot: roll, pitch, heading and mirroring. Pure.

With all of them zero the camera looks as the robot does: x forward, y left, z up (REP-103). Otherwise
    b_robot = R b_camera,    R = Rz(heading) Ry(pitch) Rx(roll)
so a positive roll lifts the camera's left side, a positive pitch puts its nose down, and a positive heading
turns its centre column to the robot's left. A camera that hangs upside-down has a roll of 180 degrees.
"""

import math
from dataclasses import dataclass

import numpy as np

from shared.geometry.perspective import rotation_y, rotation_z
from shared.geometry.sphere import FloatArray

EXACT_RAD = math.radians(0.05)
"""Less than this is no turn at all: a seventh of a column at 1024 columns; chosen."""


@dataclass(frozen=True)
class Orientation:
    """Angles of the mount, radians; `mirrored` says that the camera swaps left and right."""

    roll_rad: float = 0.0
    pitch_rad: float = 0.0
    heading_rad: float = 0.0
    mirrored: bool = False

    @classmethod
    def from_degrees(
        cls, roll_deg: float, pitch_deg: float, heading_deg: float, mirrored: bool = False
    ) -> "Orientation":
        """The same from the settings of the service."""
        return cls(math.radians(roll_deg), math.radians(pitch_deg), math.radians(heading_deg), mirrored)

    @property
    def is_none(self) -> bool:
        """Whether pictures may pass as they come."""
        angles = (self.roll_rad, self.pitch_rad, self.heading_rad)
        return not self.mirrored and all(abs(angle) <= EXACT_RAD for angle in angles)

    @property
    def rotation(self) -> FloatArray:
        """R_robot_camera (3, 3): maps bearings of the (unmirrored) camera to the robot's frame."""
        return rotation_z(self.heading_rad) @ rotation_y(self.pitch_rad) @ rotation_x(self.roll_rad)

    @property
    def up(self) -> FloatArray:
        """Where the robot's up is, unit vector (3,) in the camera's frame."""
        return np.asarray(self.rotation[2], dtype=np.float64)


def levelled(up: FloatArray, orientation: Orientation) -> Orientation:
    """The orientation that makes `up`, unit vector (3,) in the camera's frame, the robot's; same heading."""
    roll = math.atan2(up[1], up[2])
    pitch = math.atan2(-up[0], math.hypot(up[1], up[2]))
    return Orientation(roll, pitch, orientation.heading_rad, orientation.mirrored)


def rotation_x(angle_rad: float) -> FloatArray:
    """Rotation about x, (3, 3); a positive angle lifts y."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
