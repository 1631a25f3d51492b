"""Edges that true poses contradict. Pure."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from shared.messages.maps import Edge
from shared.messages.simulation import Pose

MAX_ERROR_RAD = math.radians(20.0)
MAX_BLIND_M = 3.0

LineOfSight = Callable[[tuple[float, float], tuple[float, float]], bool]


@dataclass(frozen=True)
class EdgeCheck:
    """One edge against the truth.

    Attributes:
        errors_rad: errors of the stored bearings (a to b, b to a), those there are.
        hidden: the ends are further apart than allowed and cannot see each other.
    """

    a: int
    b: int
    distance_m: float
    errors_rad: tuple[float, ...]
    hidden: bool

    @property
    def false(self) -> bool:
        """A stored bearing is wrong by more than 20 degrees, or the ends are far apart and out of sight."""
        return self.hidden or any(error > MAX_ERROR_RAD for error in self.errors_rad)


def check_edges(
    edges: Iterable[Edge], poses: Mapping[int, Pose], sight: LineOfSight, blind_m: float = MAX_BLIND_M
) -> list[EdgeCheck]:
    """Check all edges; longer than `blind_m` their ends must see each other."""
    return [_check(edge, poses[edge.a], poses[edge.b], sight, blind_m) for edge in edges]


def true_bearing_rad(origin: Pose, target: Pose) -> float:
    """Direction from one pose to another in the frame of the first, radians."""
    absolute = math.atan2(target.y_m - origin.y_m, target.x_m - origin.x_m)
    return math.remainder(absolute - origin.yaw_rad, math.tau)


def _check(edge: Edge, a: Pose, b: Pose, sight: LineOfSight, blind_m: float) -> EdgeCheck:
    distance_m = math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)
    stored = ((edge.heading_ab_rad, true_bearing_rad(a, b)), (edge.heading_ba_rad, true_bearing_rad(b, a)))
    errors = tuple(abs(math.remainder(s - true, math.tau)) for s, true in stored if s is not None)
    hidden = distance_m > blind_m and not sight((a.x_m, a.y_m), (b.x_m, b.y_m))
    return EdgeCheck(edge.a, edge.b, distance_m, errors, hidden)
