"""Oscillation of a driven way: how often the robot turns back on itself. Pure."""

import math
from collections.abc import Sequence

from shared.messages.simulation import Truth

STEP_M = 0.05
"""Moves are measured between spots at least this far apart: the noise of standing still is no turn."""

BACK_RAD = math.radians(120.0)
"""Sharper than any corner of a way round furniture; straight back is 180."""


def reversals(truths: Sequence[Truth]) -> int:
    """Times the direction of travel changed by more than 120 degrees from one move to the next."""
    count, previous_rad = 0, None
    if not truths:
        return 0
    anchor = truths[0].pose
    for truth in truths[1:]:
        dx, dy = truth.pose.x_m - anchor.x_m, truth.pose.y_m - anchor.y_m
        if math.hypot(dx, dy) < STEP_M:
            continue
        heading_rad = math.atan2(dy, dx)
        if previous_rad is not None and abs(math.remainder(heading_rad - previous_rad, math.tau)) > BACK_RAD:
            count += 1
        previous_rad, anchor = heading_rad, truth.pose
    return count


def longest_stay(truths: Sequence[Truth], radius_m: float) -> int:
    """Most frames in a row within `radius_m` of where they began: a robot stuck in a corner."""
    longest = start = 0
    for end, truth in enumerate(truths):
        while _apart_m(truths[start], truth) > radius_m:
            start += 1
        longest = max(longest, end - start + 1)
    return longest


def _apart_m(a: Truth, b: Truth) -> float:
    return math.hypot(b.pose.x_m - a.pose.x_m, b.pose.y_m - a.pose.y_m)
