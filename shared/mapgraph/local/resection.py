"""Where a frame was taken, by all that it sees of the nodes around: resection in a local map. Pure.

Bearings of known nodes cross at one point. Along a corridor they hardly cross: there distances decide, which
follow from matches up to one factor: views carry further in one place than in the next one. It is solved for
with the position. For a node at p, seen in direction u with normal n, by its matches d away:

    n . (p - x) = 0 +- bearing error times distance,    u . (p - x) = f d +- a share of it,

in x and f, by least squares with Cauchy weights.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import Claim
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.relative_poses import (
    BEARING_RAD,
    POINT_M,
    ROUNDS,
    YAW_RAD,
    RelativePose,
    cauchy,
    relative_poses,
)
from shared.mapgraph.local.sights import SPOT_M

FloatArray = npt.NDArray[np.float64]

FACTOR_SHARE = 0.3
"""Error of the factor f, which is about 1: how far views carry differs so much within one place."""
RANGE_SHARE = 0.35
RANGE_M = 0.1
"""Error of one distance beside that of the factor, as a share of it and in metres (view_range)."""


@dataclass(frozen=True)
class _Equations:
    """axes (M, 3) . (x, y, factor) = values (M,) +- spread (M,)."""

    axes: FloatArray
    values: FloatArray
    spread: FloatArray

    def solved(self, start: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(3,) unknowns and their (3, 3) covariance."""
        unknowns, normal = start, np.eye(3)
        for _ in range(ROUNDS):
            residual = (self.values - self.axes @ unknowns) / self.spread
            weighted = self.axes * (cauchy(residual) / self.spread**2)[:, None]
            normal = weighted.T @ self.axes
            unknowns = np.asarray(np.linalg.solve(normal, weighted.T @ self.values), dtype=np.float64)
        return unknowns, np.asarray(np.linalg.inv(normal), dtype=np.float64)


def resected(
    graph: MapGraph,
    claims: Mapping[int, Claim],
    root: int,
    most: int,
    reckoned: Displacement | None = None,
) -> Displacement | None:
    """Where a frame is in the camera frame of one of its nodes; None where nothing says it.

    Args:
        graph: the map.
        claims: what the frame claims of nodes, those that lie elsewhere removed.
        root: the node to say it of.
        most: nodes reckoned with, nearest to the root by number of edges first.
        reckoned: where the frame is by what the robot did; counts by its spread.

    Bearings are lines to the equations: where they nearly agree they may cross behind the camera. A point
    from which half of what is seen ahead lies behind is none (cheirality, as in two-view geometry).
    """
    wanted = {*claims, *([reckoned.node_id] if reckoned is not None else [])}
    poses = relative_poses(graph, root, wanted, most) if root in graph.nodes else {}
    seen = [(poses[node], claim) for node, claim in claims.items() if node in poses]
    if not seen:
        return None
    yaw_rad = _yaw_rad(seen)
    parts = [_Equations(np.array([[0, 0, 1.0]]), np.ones(1), np.array([FACTOR_SHARE]))]
    parts += [_sight(pose, claim, yaw_rad) for pose, claim in seen]
    if reckoned is not None and reckoned.node_id in poses:
        parts.append(_driven(poses[reckoned.node_id], reckoned))
    together = _Equations(
        np.concatenate([part.axes for part in parts]),
        np.concatenate([part.values for part in parts]),
        np.concatenate([part.spread for part in parts]),
    )
    start = np.median([_guess_m(pose, claim, yaw_rad) for pose, claim in seen], axis=0)
    (x_m, y_m, _), covariance = together.solved(np.array([*start, 1.0]))
    if 2 * sum(_is_behind(pose, claim, yaw_rad, (x_m, y_m)) for pose, claim in seen) >= len(seen):
        return None
    spread_m = math.sqrt(float(np.linalg.eigvalsh(covariance[:2, :2])[-1]) + POINT_M**2)
    return Displacement(root, float(x_m), float(y_m), yaw_rad, spread_m)


def bearing_miss_rad(
    graph: MapGraph, claims: Mapping[int, Claim], at: Displacement, most: int
) -> float | None:
    """By how much the bearings claimed miss the nodes, seen from where they put the frame, at the median.

    None where no node lies far enough from there to have a bearing.

    Args:
        graph: the map.
        claims: those that `at` was resected by.
        at: where they put the frame.
        most: nodes reckoned with, as in `resected`.
    """
    poses = relative_poses(graph, at.node_id, set(claims), most)
    misses = []
    for node, claim in claims.items():
        if claim.heading_rad is None or node not in poses:
            continue
        ahead_m, aside_m = poses[node].position_m - np.array([at.x_m, at.y_m])
        if math.hypot(ahead_m, aside_m) >= SPOT_M:
            there_rad = math.atan2(aside_m, ahead_m)
            misses.append(abs(math.remainder(there_rad - at.yaw_rad - claim.heading_rad, math.tau)))
    return float(np.median(misses)) if misses else None


def _yaw_rad(seen: list[tuple[RelativePose, Claim]]) -> float:
    """Yaw of the frame's camera in the root's frame: that which most nodes agree on."""
    said = np.array([pose.yaw_rad - claim.yaw_rad for pose, claim in seen])
    spread = np.array([math.hypot(YAW_RAD, pose.yaw_std_rad) for pose, _ in seen])
    miss = np.remainder(said[:, None] - said[None, :] + np.pi, math.tau) - np.pi
    weight = cauchy(miss / spread[:, None]) / spread[:, None] ** 2
    middle = int(np.argmax(weight.sum(axis=0)))
    step = float((weight * miss)[:, middle].sum() / weight[:, middle].sum())
    return math.remainder(float(said[middle]) + step, math.tau)


def _guess_m(pose: RelativePose, claim: Claim, yaw_rad: float) -> FloatArray:
    """(2,) where one node alone puts the frame."""
    angle_rad = yaw_rad + (claim.heading_rad or 0.0)
    return pose.position_m - claim.length_m * np.array([math.cos(angle_rad), math.sin(angle_rad)])


def _is_behind(pose: RelativePose, claim: Claim, yaw_rad: float, at_m: tuple[float, float]) -> bool:
    """Whether a node lies against the direction in which a frame taken there sees it."""
    if claim.heading_rad is None:
        return False
    angle_rad = yaw_rad + claim.heading_rad
    gap = pose.position_m - np.array(at_m)
    return bool(gap @ np.array([math.cos(angle_rad), math.sin(angle_rad)]) < -SPOT_M)


def _sight(pose: RelativePose, claim: Claim, yaw_rad: float) -> _Equations:
    """One node: across and along its bearing; both axes alike where it is this very spot."""
    angle_rad = yaw_rad + (claim.heading_rad or 0.0)
    along = np.array([math.cos(angle_rad), math.sin(angle_rad)])
    across = np.array([-along[1], along[0]])
    if claim.heading_rad is None:
        length_m, aside_m, far_m = 0.0, SPOT_M, SPOT_M
    else:
        length_m = claim.length_m
        aside_m = math.hypot(max(BEARING_RAD, claim.heading_std_rad) * length_m, POINT_M)
        far_m = RANGE_SHARE * length_m + RANGE_M
    known = [float(axis @ pose.covariance_m2 @ axis) for axis in (across, along)]
    return _Equations(
        np.array([[*across, 0.0], [*along, length_m]]),
        np.array([across @ pose.position_m, along @ pose.position_m]),
        np.sqrt([aside_m**2 + known[0], far_m**2 + known[1]]),
    )


def _driven(pose: RelativePose, reckoned: Displacement) -> _Equations:
    """The position that the robot's own motion says."""
    cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    turn = np.array([[cos, -sin], [sin, cos]])
    at = pose.position_m + turn @ np.array([reckoned.x_m, reckoned.y_m])
    spread = np.sqrt(np.diag(pose.covariance_m2) + reckoned.spread_m**2 + POINT_M**2)
    return _Equations(np.eye(2, 3), at, spread)
