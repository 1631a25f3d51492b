"""Where a robot has got to since a moment: by its odometry where it has any, else by what it was told. Pure.

All times are nanoseconds of the clock that stamps the robot's frames and distances: no other clock has a say.
"""

import math
from bisect import bisect_right
from collections import deque
from dataclasses import dataclass, replace

from shared.messages.body import Odometry
from shared.messages.drive import Velocity
from shared.motion.motion import NO_MOTION, Motion, driven

KEPT = 1_000
"""Velocities and poses remembered; chosen: 10 s of odometry at 100 Hz, longer than any frame may live."""
GAP_NS = 300_000_000
"""Odometry tells a moment this far from its nearest pose, by the velocity measured there; chosen: one that
comes ten times a second may lose two of them."""


@dataclass(frozen=True)
class _Told:
    """A velocity and from when to when it held."""

    from_ns: int
    until_ns: int
    velocity: Velocity


class Reckoning:
    """Hears what the robot is told and what it measures, and says how it moved between two moments."""

    def __init__(self) -> None:
        self._told: deque[_Told] = deque(maxlen=KEPT)
        self._poses: deque[Odometry] = deque(maxlen=KEPT)

    def told(self, velocity: Velocity, hold_s: float | None = None) -> None:
        """The robot is told to move like this, from `velocity.at_ns` on.

        Args:
            velocity: with the time it was decided at; without one it says nothing.
            hold_s: how long it holds unless another one comes; its ttl by default.
        """
        if not velocity.at_ns:
            return
        if self._told and velocity.at_ns < self._told[-1].from_ns:
            self._told.clear()  # the robot's clock was set back: what was before is on no axis with it
        hold_ns = 1_000_000 * velocity.ttl_ms if hold_s is None else round(1e9 * hold_s)
        self._told.append(_Told(velocity.at_ns, velocity.at_ns + hold_ns, velocity))

    def measured(self, odometry: Odometry) -> None:
        """The robot says where it has got to."""
        if self._poses and odometry.stamp_ns <= self._poses[-1].stamp_ns:
            if odometry.stamp_ns == self._poses[-1].stamp_ns:
                return
            self._poses.clear()
        self._poses.append(odometry)

    def between(self, start_ns: int, end_ns: int) -> Motion:
        """The motion from one moment to a later one; none where they are the wrong way round."""
        if end_ns <= start_ns:
            return NO_MOTION
        start, end = self._pose_at(start_ns), self._pose_at(end_ns)
        if start is not None and end is not None:
            whole = start.inverse().then(end)  # a yaw may wrap in between
            return replace(whole, turn_rad=math.remainder(whole.turn_rad, math.tau))
        return self._by_commands(start_ns, end_ns)

    def _by_commands(self, start_ns: int, end_ns: int) -> Motion:
        whole = NO_MOTION
        for place, told in enumerate(self._told):
            last_ns = self._told[place + 1].from_ns if place + 1 < len(self._told) else end_ns
            from_ns, until_ns = max(start_ns, told.from_ns), min(end_ns, told.until_ns, last_ns)
            if until_ns > from_ns:
                whole = whole.then(_held(told.velocity, 1e-9 * (until_ns - from_ns)))
        return whole

    def _pose_at(self, stamp_ns: int) -> Motion | None:
        """Where odometry puts the robot; None where it is silent."""
        poses = self._poses
        after = bisect_right(poses, stamp_ns, key=lambda pose: pose.stamp_ns)
        for nearest in (after - 1, after):
            if 0 <= nearest < len(poses) and abs(stamp_ns - poses[nearest].stamp_ns) <= GAP_NS:
                known = poses[nearest]
                from_then = _held(known, 1e-9 * (stamp_ns - known.stamp_ns))
                return Motion(known.x_m, known.y_m, known.yaw_rad).then(from_then)
        return None


def _held(velocity: Velocity | Odometry, duration_s: float) -> Motion:
    return driven(velocity.forward_mps, velocity.left_mps, velocity.turn_radps, duration_s)
