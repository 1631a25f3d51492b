"""From velocity.v1 to how the base is to move, and when it is to stand. Pure: times are monotonic seconds."""

from collections import deque

from services.ros.conversions.twist import STAND, Motion, MotionLimits
from shared.messages.drive import Velocity

MOST_AGE_S = 3.0
"""A frame becomes a velocity within this, as in the simulator: one for an older frame was held up."""


class Driving:
    """Remembers the newest velocity and how long it counts."""

    def __init__(self, limits: MotionLimits) -> None:
        self._limits = limits
        self._sent: deque[tuple[int, float]] = deque()
        self._motion, self._until_s = STAND, 0.0

    def frame_out(self, seq: int, now_s: float) -> None:
        """Note that a frame went to topnav: velocities answer it."""
        self._sent.append((seq, now_s))

    def hear(self, velocity: Velocity, came_s: float, now_s: float) -> str:
        """Take a velocity that came at `came_s`, at the earliest; returns why it does not count, or ""."""
        while len(self._sent) > 1 and now_s - self._sent[0][1] > MOST_AGE_S:
            self._sent.popleft()
        if not self._sent or not self._sent[0][0] <= velocity.seq <= self._sent[-1][0]:
            return f"a velocity for frame {velocity.seq}, which did not go out in the last {MOST_AGE_S:g} s"
        if velocity.left_mps and not self._limits.left_mps:
            return (
                f"{velocity.left_mps:.2f} m/s to the left of a base that cannot roll so: set TOPNAV_BASE "
                "to that of this robot"
            )
        wanted = Motion(velocity.forward_mps, velocity.left_mps, velocity.turn_radps)
        self._motion, self._until_s = self._limits.within(wanted), came_s + velocity.ttl_ms / 1000.0
        return ""

    def forget(self) -> None:
        """Let no velocity count any more."""
        self._motion, self._until_s = STAND, 0.0

    def wanted(self, now_s: float, hold: bool) -> Motion:
        """How the base is to move now; not at all where it must `hold`, whatever is wished."""
        return STAND if hold or now_s >= self._until_s else self._motion
