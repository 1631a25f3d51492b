"""What the robot did between two frames and since the newest, and which distances belong to a frame. Pure.

Frames are some tenths of a second old when they are decided about, distances hardly: all is told apart by the
stamps of the robot's own clock. Where frames are stamped by another one, nothing is known of their age.
"""

from collections import deque

from services.planner.ports import Observation
from shared.messages.body import Odometry
from shared.messages.drive import Velocity
from shared.messages.features import Features
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION, Motion
from shared.motion.reckoning import Reckoning

KEPT = 64
"""Distances remembered; chosen: 6 s of them at ten a second, older than any frame that is decided about."""
OLDEST_NS = 3_000_000_000
"""A frame further from the newest distances is of another clock, or of a robot before a restart."""


class FrameMotion:
    """Reckons by odometry, or by velocities told: wheels slip, so these are good to some 20 %."""

    def __init__(self) -> None:
        self._reckoning = Reckoning()
        self._ranges: deque[Ranges] = deque(maxlen=KEPT)
        self._came_s = 0.0
        self._stamp_ns: int | None = None

    def told(self, velocity: Velocity) -> None:
        """The robot moves like this now; in lockstep until the next frame, however long its ttl."""
        step_s = self._ranges[-1].step_s if self._ranges else None
        self._reckoning.told(velocity, None if step_s is None else max(step_s, 1e-3 * velocity.ttl_ms))

    def measured(self, odometry: Odometry) -> None:
        """The robot says where it has got to."""
        self._reckoning.measured(odometry)

    def sensed(self, ranges: Ranges, now_s: float) -> None:
        """New distances, which came at `now_s`, monotonic."""
        if self._ranges and ranges.stamp_ns < self._ranges[-1].stamp_ns:
            self._ranges.clear()
        if not self._ranges or ranges.stamp_ns > self._ranges[-1].stamp_ns:
            self._ranges.append(ranges)
            self._came_s = now_s

    def observe(self, features: Features, now_s: float) -> Observation:
        """A frame with the distances of its moment and the motion since the frame before, and since it.

        A frame asked for again, as a question about it was not answered in time, tells of no motion: that was
        reckoned with already.
        """
        stamp_ns, newest = features.stamp_ns, self._ranges[-1]
        before_ns, self._stamp_ns = self._stamp_ns, stamp_ns
        moved = NO_MOTION if before_ns is None else self._reckoning.between(before_ns, stamp_ns)
        if abs(newest.stamp_ns - stamp_ns) > OLDEST_NS:
            return Observation(features, newest, moved)
        beside = min(self._ranges, key=lambda ranges: abs(ranges.stamp_ns - stamp_ns))
        return Observation(features, beside, moved, self._since(stamp_ns, newest, now_s))

    def _since(self, stamp_ns: int, newest: Ranges, now_s: float) -> Motion:
        waited_s = 0.0 if newest.lockstep else now_s - self._came_s
        return self._reckoning.between(stamp_ns, newest.stamp_ns + round(1e9 * waited_s))
