"""A motion over the floor: how far, where to and by how much turned. Pure.

Frames: x ahead of the robot, y to its left, angles counter-clockwise. A motion is told in the robot's frame
at its beginning.
"""

import math
from dataclasses import dataclass

STRAIGHT_RAD = 1e-9
"""A turn below which an arc is a straight line: its chord differs by less than rounding does."""


@dataclass(frozen=True)
class Motion:
    """Of the robot from one moment to a later one.

    Attributes:
        x_m, y_m: ahead and to the left, in the robot's frame at the earlier moment.
        turn_rad: of its frame, counter-clockwise, whole turns counted.
    """

    x_m: float = 0.0
    y_m: float = 0.0
    turn_rad: float = 0.0

    @property
    def way_m(self) -> float:
        """Distance between its ends, as the crow flies."""
        return math.hypot(self.x_m, self.y_m)

    def then(self, later: "Motion") -> "Motion":
        """This one and a later one, which begins where this one ends."""
        x_m, y_m = rotated(later.x_m, later.y_m, self.turn_rad)
        return Motion(self.x_m + x_m, self.y_m + y_m, self.turn_rad + later.turn_rad)

    def inverse(self) -> "Motion":
        """Back to where it began, in the robot's frame at its end."""
        x_m, y_m = rotated(-self.x_m, -self.y_m, -self.turn_rad)
        return Motion(x_m, y_m, -self.turn_rad)

    def direction(self, bearing_rad: float, distance_m: float | None = None) -> float:
        """Bearing, at the end, of what had this one at the beginning; without a distance it is far away."""
        if distance_m is not None:
            x_m = distance_m * math.cos(bearing_rad) - self.x_m
            y_m = distance_m * math.sin(bearing_rad) - self.y_m
            bearing_rad = math.atan2(y_m, x_m)
        return math.remainder(bearing_rad - self.turn_rad, math.tau)


NO_MOTION = Motion()


def rotated(x_m: float, y_m: float, turn_rad: float) -> tuple[float, float]:
    """A vector turned counter-clockwise."""
    cos, sin = math.cos(turn_rad), math.sin(turn_rad)
    return cos * x_m - sin * y_m, sin * x_m + cos * y_m


def driven(forward_mps: float, left_mps: float, turn_radps: float, duration_s: float) -> Motion:
    """What a constant velocity comes to: an arc, as its exponential map says.

    Args:
        forward_mps: along the robot's own x, which turns with it.
        left_mps: along its y.
        turn_radps: counter-clockwise.
        duration_s: for how long.
    """
    turn_rad = turn_radps * duration_s
    x_m, y_m = forward_mps * duration_s, left_mps * duration_s
    if abs(turn_rad) < STRAIGHT_RAD:
        return Motion(x_m, y_m, turn_rad)
    along, across = math.sin(turn_rad) / turn_rad, (1.0 - math.cos(turn_rad)) / turn_rad
    return Motion(along * x_m - across * y_m, across * x_m + along * y_m, turn_rad)
