"""Where a frame was taken relative to a node. Pure."""

import math
from dataclasses import dataclass, replace

from shared.motion.motion import Motion, rotated

DRIFT = 0.15
"""Share of a way that the robot may be off its end: wheels slip, walls are touched."""
TURN_DRIFT = 0.1
"""Share of a turn that it may be off: 30 degrees and 3, where it has no odometry and its wheels lag."""
BEARING_FROM_M = 0.4
"""From here on the bearing of the node left tells the direction better than the commands do."""

ASTRAY_RAD = math.radians(45.0)
"""A bearing this far from where the commands led is wrong, however sure; chosen: a base that slides along
what it touches goes half of its way."""


@dataclass(frozen=True)
class Displacement:
    """A frame in a node's camera frame.

    Attributes:
        node_id: the node.
        x_m, y_m: ahead of the node's camera, and to its left.
        yaw_rad: of the frame's camera; yaw_std_rad: its standard deviation, by turns since the node was seen.
        spread_m: standard deviation of the position in either direction.
    """

    node_id: int
    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0
    spread_m: float = 0.0
    yaw_std_rad: float = 0.0

    @property
    def length_m(self) -> float:
        """How far the frame is from the node."""
        return math.hypot(self.x_m, self.y_m)

    @property
    def back_rad(self) -> float:
        """Bearing of the node in the frame."""
        return math.remainder(math.atan2(-self.y_m, -self.x_m) - self.yaw_rad, math.tau)

    def moved(self, motion: Motion) -> "Displacement":
        """After the robot moved on."""
        x_m, y_m = rotated(motion.x_m, motion.y_m, self.yaw_rad)
        return replace(
            self,
            x_m=self.x_m + x_m,
            y_m=self.y_m + y_m,
            yaw_rad=self.yaw_rad + motion.turn_rad,
            spread_m=self.spread_m + DRIFT * motion.way_m,
            yaw_std_rad=self.yaw_std_rad + TURN_DRIFT * abs(motion.turn_rad),
        )

    def facing(self, yaw_rad: float) -> "Displacement":
        """With the yaw of its camera as it is seen."""
        return replace(self, yaw_rad=yaw_rad, yaw_std_rad=0.0)

    def turned(self, yaw_rad: float, heading_rad: float | None) -> "Displacement":
        """With what the frame sees of the node: the yaw of its camera, and the bearing it lies at."""
        if heading_rad is None or self.length_m < BEARING_FROM_M:
            return self.facing(-yaw_rad)
        away_rad, length_m = heading_rad - yaw_rad + math.pi, self.length_m
        if abs(math.remainder(away_rad - math.atan2(self.y_m, self.x_m), math.tau)) > ASTRAY_RAD:
            return self.facing(-yaw_rad)
        x_m, y_m = length_m * math.cos(away_rad), length_m * math.sin(away_rad)
        return replace(self.facing(-yaw_rad), x_m=x_m, y_m=y_m)


def seen_from(
    node_id: int, heading_rad: float | None, yaw_rad: float, length_m: float, spread_m: float
) -> Displacement:
    """Where a frame is that sees a node about so far away; at the node where there is no direction."""
    if heading_rad is None:
        return Displacement(node_id, yaw_rad=-yaw_rad, spread_m=spread_m)
    away_rad = heading_rad - yaw_rad + math.pi
    x_m, y_m = length_m * math.cos(away_rad), length_m * math.sin(away_rad)
    return Displacement(node_id, x_m, y_m, -yaw_rad, spread_m)
