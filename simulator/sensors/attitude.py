"""How the camera leans against upright, as a rotation, and what an IMU on it reads of that. Pure.

Upright frame: x ahead, y left, z up, turned with the robot's heading. A quaternion (w, x, y, z) rotates from
the camera frame into it.
"""

import math

import numpy as np

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]
PitchRoll = tuple[float, float]
"""Nose down positive and left up positive, radians: one turn about the horizontal axis (roll, pitch, 0)."""

UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)
LEVEL: PitchRoll = (0.0, 0.0)


def leaning(tilt: PitchRoll) -> Quaternion:
    """One turn about the horizontal axis (roll, pitch, 0) by their root sum of squares, so no part in yaw."""
    pitch_rad, roll_rad = tilt
    angle = math.hypot(pitch_rad, roll_rad)
    if angle == 0.0:
        return UPRIGHT
    share = math.sin(angle / 2) / angle
    return math.cos(angle / 2), roll_rad * share, pitch_rad * share, 0.0


def composed(*turns: Quaternion) -> Quaternion:
    """Turns carried by one another, the first by the floor and the last by none: their product in that order.

    Level turns drop out, so that a single other one stays as it is to the last bit.
    """
    whole = UPRIGHT
    for turn in turns:
        if turn != UPRIGHT:
            whole = turn if whole == UPRIGHT else _product(whole, turn)
    return whole


def gravity_in(lean: Quaternion) -> Vector:
    """Direction of gravity, unit vector downwards, in the frame of a camera that leans like this."""
    w, x, y, z = lean
    # Minus the last row of the rotation matrix.
    return 2.0 * (w * y - x * z), -2.0 * (w * x + y * z), 2.0 * (x * x + y * y) - 1.0


def measured(gravity: Vector, noise_rad: float, rng: np.random.Generator) -> Vector:
    """A reading of a direction: off by normal angles of `noise_rad` about each of the two axes across it."""
    true = np.array(gravity)
    error = rng.standard_normal(3) * noise_rad
    across = error - (error @ true) * true
    off_rad = float(np.linalg.norm(across))
    if off_rad == 0.0:
        return gravity
    x, y, z = (float(v) for v in math.cos(off_rad) * true + math.sin(off_rad) / off_rad * across)
    return x, y, z


def _product(one: Quaternion, other: Quaternion) -> Quaternion:
    a, b, c, d = one
    e, f, g, h = other
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )
