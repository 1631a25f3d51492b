"""A camera mounted askew: a constant lean in a seeded direction. Pure."""

import math

from simulator.disturbances.levels import generator
from simulator.sensors.attitude import LEVEL, PitchRoll

MOST_RAD = math.radians(10.0)  # at level 1; chosen: a bracket put on by eye, or bent by a bump


def mounted(level: float, seed: int) -> PitchRoll:
    """Pitch (nose down positive) and roll (left up positive), radians; (0, 0) at level 0."""
    if level == 0.0:
        return LEVEL
    direction = float(generator(seed, "mount").uniform(-math.pi, math.pi))
    return level * MOST_RAD * math.cos(direction), level * MOST_RAD * math.sin(direction)
