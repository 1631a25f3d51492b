"""How far the robot went between two frames, by what it was commanded to do."""

import math

from shared.messages.drive import Command

LONGEST_S = 1.0
"""Between frames further apart a command has run out (its ttl is a fraction of that)."""


class CommandedMotion:
    """Reckons with the newest command; wheels slip, so it is good to some 20 %.

    Args:
        wheel_radius_m: of the robot's wheels.
    """

    def __init__(self, wheel_radius_m: float) -> None:
        self._radius_m = wheel_radius_m
        self._command: Command | None = None
        self._stamp_ns: int | None = None
        self._moved_m = (0.0, 0.0)

    def follow(self, command: Command) -> None:
        """The wheels do this now."""
        self._command = command

    def until(self, stamp_ns: int, step_s: float | None = None) -> tuple[float, float]:
        """Displacement from the frame before to the one with this stamp, robot frame, metres.

        The same frame asked for again gives the same answer.

        Args:
            stamp_ns: capture time of the frame.
            step_s: time since the frame before where stamps do not tell it (lockstep).
        """
        if stamp_ns == self._stamp_ns:
            return self._moved_m
        before_ns, self._stamp_ns = self._stamp_ns, stamp_ns
        command = self._command
        if before_ns is None or command is None or stamp_ns < before_ns:
            self._moved_m = (0.0, 0.0)
            return self._moved_m
        duration_s = step_s or min(1e-9 * (stamp_ns - before_ns), LONGEST_S)
        length_m = command.wheel_speed_radps * self._radius_m * duration_s
        self._moved_m = (length_m * math.cos(command.steer_rad), length_m * math.sin(command.steer_rad))
        return self._moved_m
