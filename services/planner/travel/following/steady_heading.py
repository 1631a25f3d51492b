"""A heading that does not turn round at once: near a repeating pattern it may flip from frame to frame."""

import math

FLIP_RAD = math.radians(100.0)
"""Turns beyond it point back; chosen: more than a corner, less than the opposite of decision 0015."""

PATIENCE = 4
"""Frames in a row that must agree before the robot turns round; chosen: 1.2 s, half a metre at most."""


class SteadyHeading:
    """Keeps the last heading towards each target for a few frames when a new one points back."""

    def __init__(self) -> None:
        self._target: int | None = None
        self._kept_rad = 0.0
        self._flips = 0

    def turned(self, turn_rad: float) -> None:
        """The robot turned, counter-clockwise: what is kept is in its frame."""
        self._kept_rad = math.remainder(self._kept_rad - turn_rad, math.tau)

    def follow(self, target: int, heading_rad: float, *, close: bool) -> float:
        """The heading to drive.

        Args:
            target: what is headed for; another one starts anew.
            heading_rad: what this frame says, robot frame.
            close: whether the target is so near that passing it may turn the heading round.
        """
        turned = abs(math.remainder(heading_rad - self._kept_rad, math.tau)) > FLIP_RAD
        if target == self._target and turned and not close and self._flips < PATIENCE:
            self._flips += 1
            return self._kept_rad
        self._target, self._kept_rad, self._flips = target, heading_rad, 0
        return heading_rad
