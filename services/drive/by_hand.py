"""A person drives: whose hand is on the robot, how long it holds, and how fast it may go. Pure."""

import math
from collections.abc import Callable

import numpy as np

from services.drive.bases.course import Twist
from services.drive.limits import DriveLimits
from shared.geometry.clearance import Obstacles
from shared.messages.drive import Manual


class Hand:
    """The hand on the robot, if any: the first keeps it until it lets go or is silent for its ttl.

    Args:
        count: counts a refused message by kind, with a text that says why.
    """

    def __init__(self, count: Callable[[str, str], None]) -> None:
        self._count = count
        self._wish: Manual | None = None
        self._until_s = -math.inf

    def hear(self, wish: Manual, now_s: float) -> None:
        """Take a message that came before `now_s`, monotonic."""
        held = self.wish(now_s)
        if held is not None and wish.who != held.who:
            self._count("taken", f"{wish.who} wishes to drive, and {held.who} does")
            return
        if held is not None and wish.seq <= held.seq:
            self._count("late", f"wish {wish.seq} of {wish.who} after {held.seq}")
            return
        self._wish = None if wish.action == "release" else wish
        self._until_s = now_s + wish.ttl_ms / 1000.0

    def wish(self, now_s: float) -> Manual | None:
        """How a person wishes the robot to move now; None while nobody drives."""
        if now_s >= self._until_s:
            self._wish = None
        return self._wish


def by_hand(wish: Manual, obstacles: Obstacles, limits: DriveLimits) -> Twist:
    """What a base does of a person's wish: within its limits, slower before what is near, never into it.

    A robot that stands too near may leave; turning on the spot is always free, for the body is round.
    """
    forward_mps, left_mps, turn_radps = wish.forward_mps, wish.left_mps, wish.turn_radps
    base = limits.base
    if base.name != "holonomic":
        left_mps = 0.0
    if base.name == "ackermann":
        most_radps = abs(forward_mps) / base.radius_m
        turn_radps = max(-most_radps, min(most_radps, turn_radps))
    wished_mps, wished_radps = math.hypot(forward_mps, left_mps), abs(turn_radps)
    if wished_mps == 0.0:
        return Twist(turn_radps=max(-base.turn_radps, min(base.turn_radps, turn_radps)))
    free_m = _free_m(forward_mps, left_mps, turn_radps, obstacles, limits)
    most_mps = min(limits.speeds.max_mps, free_m / limits.contact_s)
    share = min(1.0, most_mps / wished_mps, base.turn_radps / wished_radps if wished_radps else 1.0)
    return Twist(share * forward_mps, share * left_mps, share * turn_radps)


def _free_m(
    forward_mps: float, left_mps: float, turn_radps: float, obstacles: Obstacles, limits: DriveLimits
) -> float:
    """Way along the arc that a wish is, or where it also goes sideways along its beginning."""
    body_m = limits.passing.disc_m(0.0)
    if left_mps == 0.0:
        return obstacles.arc_clearance_m(turn_radps / forward_mps, body_m, backwards=forward_mps < 0.0)
    direction_rad = np.array([math.atan2(left_mps, forward_mps)])
    return float(obstacles.clearance_m(direction_rad, body_m)[0])
