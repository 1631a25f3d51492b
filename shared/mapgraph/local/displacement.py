"""Where a frame was taken relative to a node. Pure."""

import math
from dataclasses import dataclass, replace

DRIFT = 0.15
"""Share of a way that the robot may be off its end: wheels slip, walls are touched."""
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
        yaw_rad: of the frame's camera.
        spread_m: standard deviation of the position in either direction.
    """

    node_id: int
    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0
    spread_m: float = 0.0

    @property
    def length_m(self) -> float:
        """How far the frame is from the node."""
        return math.hypot(self.x_m, self.y_m)

    @property
    def back_rad(self) -> float:
        """Bearing of the node in the frame."""
        return math.remainder(math.atan2(-self.y_m, -self.x_m) - self.yaw_rad, math.tau)

    def moved(self, moved_m: tuple[float, float]) -> "Displacement":
        """After the robot went on by so much, in its own frame."""
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        x_m, y_m = moved_m
        return replace(
            self,
            x_m=self.x_m + cos * x_m - sin * y_m,
            y_m=self.y_m + sin * x_m + cos * y_m,
            spread_m=self.spread_m + DRIFT * math.hypot(x_m, y_m),
        )

    def turned(self, yaw_rad: float, heading_rad: float | None) -> "Displacement":
        """With what the frame sees of the node: the yaw of its camera, and the bearing it lies at."""
        if heading_rad is None or self.length_m < BEARING_FROM_M:
            return replace(self, yaw_rad=-yaw_rad)
        away_rad, length_m = heading_rad - yaw_rad + math.pi, self.length_m
        if abs(math.remainder(away_rad - math.atan2(self.y_m, self.x_m), math.tau)) > ASTRAY_RAD:
            return replace(self, yaw_rad=-yaw_rad)
        x_m, y_m = length_m * math.cos(away_rad), length_m * math.sin(away_rad)
        return replace(self, x_m=x_m, y_m=y_m, yaw_rad=-yaw_rad)


def seen_from(
    node_id: int, heading_rad: float | None, yaw_rad: float, length_m: float, spread_m: float
) -> Displacement:
    """Where a frame is that sees a node about so far away; at the node where there is no direction."""
    if heading_rad is None:
        return Displacement(node_id, yaw_rad=-yaw_rad, spread_m=spread_m)
    away_rad = heading_rad - yaw_rad + math.pi
    x_m, y_m = length_m * math.cos(away_rad), length_m * math.sin(away_rad)
    return Displacement(node_id, x_m, y_m, -yaw_rad, spread_m)
