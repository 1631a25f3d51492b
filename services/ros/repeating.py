"""When a base is told how to move: at once, again and again, and nothing any more once it stands. Pure."""

from services.ros.conversions.twist import STAND, Motion

REPEAT_S = 0.05
"""The base is told again so often: its own time-out is usually 0.5 s, and a radio link loses some; chosen."""
LAST_WORDS_S = 1.0
"""So long a robot that is to stand is told so; then others may drive it (twist_mux, a joystick); chosen."""


class Repeating:
    """Remembers what was told last; times are monotonic seconds."""

    def __init__(self) -> None:
        self._told, self._told_s = STAND, float("-inf")
        self._moved_s = float("-inf")

    def due(self, motion: Motion, now_s: float) -> bool:
        """Whether to tell the base `motion` now, which counts as told then."""
        if not motion.stands:
            self._moved_s = now_s
        elif now_s - self._moved_s > LAST_WORDS_S:
            self._told = STAND
            return False
        if motion == self._told and now_s - self._told_s < REPEAT_S:
            return False
        self._told, self._told_s = motion, now_s
        return True
