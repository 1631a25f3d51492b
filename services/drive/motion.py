"""What the robot did since a frame was taken and since the last velocity, on the robot's own clock. Pure.

The robot's time is that of its newest distances and what passed since they came, on this process's monotonic
clock. The stamp of a frame that comes from another clock makes no sense there: then nothing is corrected.
"""

from services.drive.core import Since
from shared.messages.body import Odometry
from shared.messages.drive import Heading, Velocity
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION
from shared.motion.reckoning import Reckoning

OLDEST_S = 3.0
"""A frame that is older cannot still be driven by (`inputs.DECIDING_S` and the life of a heading): its stamp
is of another clock."""


class OwnMotion:
    """Keeps the robot's time, what it was told, and what it measured."""

    def __init__(self) -> None:
        self._reckoning = Reckoning()
        self._ranges: Ranges | None = None
        self._came_s = 0.0
        self._now_ns = self._told_ns = 0

    def measured(self, odometry: Odometry) -> None:
        """The robot says where it has got to."""
        self._reckoning.measured(odometry)

    def at(self, ranges: Ranges | None, now_s: float) -> None:
        """It is `now_s` here, monotonic; these are the newest distances. In lockstep time stands still."""
        if ranges is None:
            return
        if ranges is not self._ranges:
            self._ranges, self._came_s = ranges, now_s
        waited_s = 0.0 if ranges.lockstep else now_s - self._came_s
        self._now_ns = ranges.stamp_ns + round(1e9 * waited_s)

    def since(self, heading: Heading) -> Since:
        """What the robot did since the last velocity, and since the frame of a heading."""
        step = self._reckoning.between(self._told_ns, self._now_ns) if self._told_ns else NO_MOTION
        delay_s = 1e-9 * (self._now_ns - heading.stamp_ns)
        if not 0.0 <= delay_s <= OLDEST_S:
            return Since(step)
        return Since(step, self._reckoning.between(heading.stamp_ns, self._now_ns), delay_s)

    def told(self, velocity: Velocity) -> Velocity:
        """The velocity with the time from which on the robot moves like this."""
        self._told_ns = self._now_ns
        timed = velocity.model_copy(update={"at_ns": self._now_ns})
        step_s = self._ranges.step_s if self._ranges is not None else None
        self._reckoning.told(timed, None if step_s is None else max(step_s, 1e-3 * velocity.ttl_ms))
        return timed
