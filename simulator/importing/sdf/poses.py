"""Poses of SDF 1.4 to 1.11: x y z roll pitch yaw, metres and radians, turned about fixed axes. Pure."""

import math
import xml.etree.ElementTree as ElementTree

import numpy as np
import numpy.typing as npt

from shared.geometry.perspective import rotation_y, rotation_z
from simulator.importing.entities import WorldImportError
from simulator.importing.sdf.numbers import numbers

FloatArray = npt.NDArray[np.float64]
MOST_M = 1e6  # untrusted input; what is far off is left out later


def pose_matrix(element: ElementTree.Element, where: str) -> FloatArray:
    """The <pose> below an element as a matrix, (4, 4), whatever frame it is given in.

    Raises:
        WorldImportError: not so many finite numbers, or too far away; `where` begins the message.
    """
    pose = element.find("pose")
    text = "" if pose is None else pose.text or ""
    if pose is None or not text.strip():
        return np.eye(4)
    matrix = np.eye(4)
    if pose.get("rotation_format", "euler_rpy") == "quat_xyzw":
        values = numbers(text, 7, f"{where}: pose must be x y z and a quaternion x y z w")
        matrix[:3, :3] = _rotation(values[3:], where)
    else:
        values = numbers(text, 6, f"{where}: pose must be x y z roll pitch yaw")
        scale = math.pi / 180.0 if pose.get("degrees", "false").lower() in {"true", "1"} else 1.0
        roll, pitch, yaw = (scale * value for value in values[3:])
        matrix[:3, :3] = rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll)
    if max(abs(v) for v in values[:3]) > MOST_M:
        raise WorldImportError(f"{where}: pose must lie within +-{MOST_M:g} m, got {text.strip()!r:.80}")
    matrix[:3, 3] = values[:3]
    return matrix


def frame_of(element: ElementTree.Element) -> str:
    """The frame in which the <pose> of an element is given; "" is that of what holds it."""
    pose = element.find("pose")
    return "" if pose is None else pose.get("relative_to", pose.get("frame", ""))


def rotation_x(angle_rad: float) -> FloatArray:
    """Rotation about x, (3, 3)."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _rotation(quaternion: list[float], where: str) -> FloatArray:
    length = math.hypot(*quaternion)
    if not length > 0.0:
        raise WorldImportError(f"{where}: a quaternion must not be 0, got {quaternion}")
    x, y, z, w = (value / length for value in quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
