"""Moves of a robot by hand, a hand's breadth each way, and what its camera and its wheels say of them."""

import math
import time
from collections.abc import Sequence

from services.launcher.checking.looking import Looker
from services.launcher.checking.motion import Move, Seen
from services.launcher.client.hand import Hand
from shared.messages.body import Odometry
from shared.messages.drive import Velocity
from shared.motion.motion import Motion

SPEED_MPS, TURN_RADPS = 0.15, 0.5
"""Chosen: slow enough to jump aside, fast enough for every base's motors."""
SETTLED_S = 0.7
"""Longest roll after the last word, and a shake; chosen."""
MOVING_MPS, MOVING_RADPS = 0.02, 0.05
"""By odometry; chosen: above what encoders say of a robot that stands."""


def make(move: Move, hand: Hand, looker: Looker) -> Seen:
    """Move, and compare the pictures before and after it.

    Raises:
        ExperimentError: no pictures come, or nobody compares them.
    """
    before = looker.features_after(time.time_ns())
    looker.follow()
    looker.odometry.clear()
    began_ns = time.time_ns()
    seconds = max(math.hypot(move.forward_m, move.left_m) / SPEED_MPS, abs(move.turn_rad) / TURN_RADPS)
    told = hand.move(move.forward_m / seconds, move.left_m / seconds, move.turn_rad / seconds, seconds)
    time.sleep(SETTLED_S)
    after = looker.features_after(time.time_ns())
    looker.follow()
    return Seen(
        move,
        min(1.0, _share(move, told, seconds)),
        looker.compare(before, after),
        _way(looker.odometry),
        _answer_s(looker.odometry, began_ns),
    )


def _share(move: Move, told: Sequence[Velocity], seconds: float) -> float:
    """How much of a move drive told the base: the mean of what it said, against the wish."""
    if not told:
        return 0.0
    wished = (move.forward_m / seconds, move.left_m / seconds, move.turn_rad / seconds)
    length = sum(one * one for one in wished)
    shares = [
        (v.forward_mps * wished[0] + v.left_mps * wished[1] + v.turn_radps * wished[2]) / length for v in told
    ]
    return sum(shares) / len(shares)


def _way(said: Sequence[Odometry]) -> tuple[float, float, float] | None:
    if len(said) < 2:
        return None
    first, last = (Motion(one.x_m, one.y_m, one.yaw_rad) for one in (said[0], said[-1]))
    way = first.inverse().then(last)
    return way.x_m, way.y_m, math.remainder(way.turn_rad, math.tau)


def _answer_s(said: Sequence[Odometry], began_ns: int) -> float | None:
    """From the first word until odometry says that the wheels turn, by its stamps."""
    moving = [one.stamp_ns for one in said if one.stamp_ns >= began_ns and moves(one)]
    return 1e-9 * (moving[0] - began_ns) if moving else None


def stopped_after_s(said: Sequence[Odometry], from_ns: int) -> float | None:
    """From a moment on until odometry says that the robot stands for good; None without odometry."""
    later = [one for one in said if one.stamp_ns >= from_ns]
    if not later:
        return None
    moving = [one.stamp_ns for one in later if moves(one)]
    return 1e-9 * (moving[-1] - from_ns) if moving else 0.0


def moves(one: Odometry) -> bool:
    """Whether odometry says that the robot moves."""
    return math.hypot(one.forward_mps, one.left_mps) > MOVING_MPS or abs(one.turn_radps) > MOVING_RADPS
