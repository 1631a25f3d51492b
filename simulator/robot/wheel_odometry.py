"""Odometry of a simulated base, as encoders at its wheels give it. Pure; knows no true pose.

Each wheel that rolled s in direction u of the robot's frame says u . (d + turn x p) = s, and n . (d + turn x
p) = 0 across: it does not slide. Two equations a wheel for three unknowns, solved by least squares.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from shared.motion.motion import Motion
from simulator.robot.undercarriage import Mount

FloatArray = npt.NDArray[np.float64]


def rolled(mounts: Sequence[Mount], headings_rad: Sequence[float], rolled_m: Sequence[float]) -> Motion:
    """The motion of the robot in a moment so short that its wheels roll straight on.

    Args:
        mounts: of the wheels.
        headings_rad: where each points, robot frame.
        rolled_m: how far each rolled that way.
    """
    place = np.array([(mount.x_m, mount.y_m) for mount in mounts])
    angle = np.asarray(headings_rad, dtype=np.float64)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    axes = np.concatenate([_axes(along, place), _axes(across, place)])
    values = np.concatenate([np.asarray(rolled_m, dtype=np.float64), np.zeros(len(mounts))])
    x_m, y_m, turn_rad = np.linalg.lstsq(axes, values, rcond=None)[0]
    return Motion(float(x_m), float(y_m), float(turn_rad))


def _axes(direction: FloatArray, place: FloatArray) -> FloatArray:
    """(N, 3) coefficients of (x, y, turn): a turn moves a wheel at (x, y) by (-y, x)."""
    lever = direction[:, 1] * place[:, 0] - direction[:, 0] * place[:, 1]
    return np.column_stack([direction, lever])
