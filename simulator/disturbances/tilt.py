"""A camera that is not upright: a mount bent by a seeded angle, and sway while the robot moves. Pure."""

import math

from simulator.disturbances.levels import generator
from simulator.sensors.attitude import PitchRoll

MOST_RAD = math.radians(5.0)  # constant and sway together, at level 1; chosen: seen by eye on a robot
SWAY_SHARE, SWAY_HZ = 0.3, 0.8  # chosen: a mast of a metre on soft tyres
FULL_SWAY_MPS = 0.3  # speed from which on it sways fully; chosen: just below full speed


def tilt_of(level: float, seed: int, time_s: float, speed_mps: float) -> PitchRoll:
    """Pitch (nose down positive) and roll (left up positive), radians; (0, 0) at level 0.

    The mount's part keeps its direction for a seed; the sway goes round and needs movement.
    """
    if level == 0.0:
        return 0.0, 0.0
    direction, phase = generator(seed, "tilt").uniform(-math.pi, math.pi, 2)
    swing = 2.0 * math.pi * SWAY_HZ * time_s + phase
    bent = level * MOST_RAD * (1.0 - SWAY_SHARE)
    sway = level * MOST_RAD * SWAY_SHARE * min(1.0, speed_mps / FULL_SWAY_MPS) * math.sin(swing)
    return (bent + sway) * math.cos(direction), (bent + sway) * math.sin(direction)
