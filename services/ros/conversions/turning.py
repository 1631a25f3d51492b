"""Whether scans turn as the robot does: what tells a mirrored scanner from one that is mounted right. Pure.

A robot that turns to the left sees the room turn to the right. A scanner that is mirrored (mounted upside
down and not told so) sees it turn to the left, by as much. So two scans of one spot are laid over each other
twice, turned back by what the odometry says and by its opposite; whichever fits better has a vote. A room
that looks the same both ways, and a robot that does not turn, vote for nothing. A wheel odometry with a wrong
sign is found the same way; which of the two it is, only a person can see.
"""

import math
from collections import deque

import numpy as np

from services.ros.conversions.scan import PROFILE_BINS, FloatArray

LEAST_RAD, MOST_RAD = math.radians(10.0), math.radians(60.0)
"""Turns that are compared; chosen: two bins at least, and most of the room still the same."""
SAME_SPOT_M = 0.15
"""Travel between two scans that are compared; chosen: a tenth of what is usually seen."""
BETTER, BETTER_M = 2.0, 0.05
"""So many times, and metres, better than the other way must one fit to have a vote; chosen: ranges of 1 cm
noise, bins of 5 degrees."""
LEAST_SHARE = 0.3
"""Of all bins, so many must have a hit in both scans; chosen."""
VOTES, ENOUGH = 8, 5
"""Latest votes that count, and how many of them decide; chosen: one person who walks past turns none."""


class TurningCheck:
    """Remembers one scan at a time and the votes."""

    def __init__(self) -> None:
        self._reference: tuple[FloatArray, float, float, float] | None = None
        self._votes: deque[bool] = deque(maxlen=VOTES)

    @property
    def mirrored(self) -> bool:
        """Whether scans turn the wrong way."""
        return self._votes.count(True) >= ENOUGH

    @property
    def confirmed(self) -> bool:
        """Whether they turn the right way."""
        return self._votes.count(False) >= ENOUGH

    def see(self, profile_m: FloatArray, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Take a scan's profile and the odometry's pose at its time."""
        if self._reference is None:
            self._reference = profile_m, x_m, y_m, yaw_rad
            return
        before_m, x0_m, y0_m, yaw0_rad = self._reference
        turn_rad = math.remainder(yaw_rad - yaw0_rad, math.tau)
        if math.hypot(x_m - x0_m, y_m - y0_m) > SAME_SPOT_M or abs(turn_rad) > MOST_RAD:
            self._reference = profile_m, x_m, y_m, yaw_rad
        elif abs(turn_rad) >= LEAST_RAD:
            vote = mirrored_vote(before_m, profile_m, turn_rad)
            if vote is not None:
                self._votes.append(vote)
            self._reference = profile_m, x_m, y_m, yaw_rad


def mirrored_vote(before_m: FloatArray, after_m: FloatArray, turn_rad: float) -> bool | None:
    """Whether two profiles of a spot fit better by the opposite of the turn between them; None if unsure.

    Args:
        before_m: (PROFILE_BINS,) nearest hits, NaN where there is none.
        after_m: the same after the turn.
        turn_rad: counter-clockwise.
    """
    right_m, wrong_m = (_misfit_m(before_m, after_m, turn) for turn in (turn_rad, -turn_rad))
    if right_m is None or wrong_m is None:
        return None
    if wrong_m > BETTER * right_m + BETTER_M:
        return False
    if right_m > BETTER * wrong_m + BETTER_M:
        return True
    return None


def _misfit_m(before_m: FloatArray, after_m: FloatArray, turn_rad: float) -> float | None:
    """Median difference where both have a hit: what was at bearing b is at b - turn now."""
    bins = round(turn_rad * PROFILE_BINS / math.tau)
    difference_m = np.abs(after_m - np.roll(before_m, -bins))
    both = np.isfinite(difference_m)
    return float(np.median(difference_m[both])) if both.mean() >= LEAST_SHARE else None
