"""Random pairs of camera poses with a free line of sight between them. Pure."""

import math
from dataclasses import dataclass

import numpy as np

from shared.messages.simulation import Pose
from simulator.world.freespace import FreeSpace

APART_M = (0.3, 3.0)
"""Where the planner asks for headings indoors: neighbouring nodes lie 0.5 m apart, edges reach about 3 m."""

MAX_DRAWS = 10_000
"""A world without room must end, too; drawing so often takes about a second."""


@dataclass(frozen=True)
class PosePair:
    """Two poses; the first looks for the way to the second.

    Attributes:
        is_free: a robot can drive straight from one to the other.
    """

    current: Pose
    target: Pose
    is_free: bool = True

    @property
    def distance_m(self) -> float:
        """How far apart they are."""
        return math.hypot(self.target.x_m - self.current.x_m, self.target.y_m - self.current.y_m)

    @property
    def heading_rad(self) -> float:
        """True direction from the first to the second, camera frame of the first."""
        dx, dy = self.target.x_m - self.current.x_m, self.target.y_m - self.current.y_m
        return math.remainder(math.atan2(dy, dx) - self.current.yaw_rad, math.tau)

    @property
    def yaw_rad(self) -> float:
        """True turn from the first camera to the second."""
        return math.remainder(self.target.yaw_rad - self.current.yaw_rad, math.tau)


def draw_pairs(
    space: FreeSpace, count: int, rng: np.random.Generator, apart_m: tuple[float, float] = APART_M
) -> list[PosePair]:
    """Pairs whose distance is even in `apart_m`, both ends on free floor, seeing each other."""
    return [draw_pair(space, rng, float(rng.uniform(*apart_m))) for _ in range(count)]


def draw_pair(space: FreeSpace, rng: np.random.Generator, distance_m: float) -> PosePair:
    """One pair.

    Raises:
        ValueError: the free floor has no room for any.
    """
    for _ in range(MAX_DRAWS):
        x_m, y_m, yaw_rad = space.random_pose(rng)
        bearing, other_yaw_rad = (float(angle) for angle in rng.uniform(-math.pi, math.pi, 2))
        end = (x_m + distance_m * math.cos(bearing), y_m + distance_m * math.sin(bearing))
        if space.is_free(end) and space.line_of_sight((x_m, y_m), end):
            target = Pose(x_m=end[0], y_m=end[1], yaw_rad=other_yaw_rad)
            is_free = space.is_free_way((x_m, y_m), end)
            return PosePair(Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad), target, is_free)
    raise ValueError(f"no two free spots {distance_m:.2f} m apart that see each other in {MAX_DRAWS} draws")
