"""How good a map is, judged on the true poses of its nodes: coverage, connected parts, false edges. Pure."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.messages.maps import Edge
from shared.messages.simulation import Pose

FloatArray = npt.NDArray[np.float64]
CHUNK = 4096
"""Floor points compared with all nodes at once: some megabytes for a map of 100 nodes."""

MAX_ERROR_RAD = math.radians(20.0)
"""Twelve times the largest error that `make demo` measures in a stored bearing (1.6 degrees)."""

MAX_BLIND_M = 3.0
"""Distance sensors see 4 m indoors: up to here a frame may look over what stands in between."""

LineOfSight = Callable[[tuple[float, float], tuple[float, float]], bool]


def coverage(floor_m: FloatArray, nodes_m: FloatArray, radius_m: float = 1.0) -> float:
    """Fraction of floor points within `radius_m` of a node.

    Args:
        floor_m: (N, 2) centres of equal cells of the free floor that the robot can reach, metres.
        nodes_m: (M, 2) true positions of the nodes, metres.
        radius_m: how far a node reaches, metres.

    Raises:
        ValueError: no floor.
    """
    if len(floor_m) == 0:
        raise ValueError("floor_m must hold at least one point, got none")
    if len(nodes_m) == 0:
        return 0.0
    near = 0
    for start in range(0, len(floor_m), CHUNK):
        gap = floor_m[start : start + CHUNK, None, :] - nodes_m[None, :, :]
        near += int(((gap**2).sum(axis=-1).min(axis=1) <= radius_m**2).sum())
    return near / len(floor_m)


def components(nodes: Iterable[int], edges: Iterable[tuple[int, int]]) -> int:
    """Number of connected parts of a graph."""
    parent = {node: node for node in nodes}

    def root(node: int) -> int:
        while parent[node] != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    for a, b in edges:
        parent[root(a)] = root(b)
    return sum(root(node) == node for node in parent)


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
