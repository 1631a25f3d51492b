"""Wheels that slip, and motors that do not start: what a robot does of what it is told. Pure.

Slip is drawn anew every second, for each way to move by itself, so that a robot told to go straight on
also leaves its course. The encoders count what the wheels rolled, so odometry says too much by as much.
"""

import math
from dataclasses import dataclass

from shared.motion.motion import Motion
from simulator.disturbances.levels import Disturbances, generator

MOST_SLIP = 0.3
"""Share of the way that is lost at most at level 1; chosen: rubber on a wet floor."""
MOST_DEADBAND_MPS = 0.1
"""Slowest speed of a wheel at level 1; chosen: a cheap gear motor at a twentieth of its voltage."""


@dataclass(frozen=True)
class Traction:
    """Of a robot at a moment.

    Attributes:
        forward, left, turn: shares of what the wheels roll by which the robot moves, 1 without slip.
        deadband_mps: a wheel that is to roll more slowly stands still.
    """

    forward: float = 1.0
    left: float = 1.0
    turn: float = 1.0
    deadband_mps: float = 0.0

    def rolled(self, moved: Motion) -> Motion:
        """What the wheels rolled where the robot moved like this."""
        return Motion(moved.x_m / self.forward, moved.y_m / self.left, moved.turn_rad / self.turn)


FULL = Traction()


def traction_of(levels: Disturbances, seed: int, time_s: float) -> Traction:
    """The traction in this second."""
    if not (levels.slip or levels.deadband):
        return FULL
    lost = generator(seed, "slip", math.floor(time_s)).uniform(0.0, MOST_SLIP * levels.slip, 3)
    forward, left, turn = (1.0 - float(share) for share in lost)
    return Traction(forward, left, turn, MOST_DEADBAND_MPS * levels.deadband)
