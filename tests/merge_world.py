"""Places on a plane with known poses: maps of them, and what matching two such maps finds."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from services.gateway.merging.core.places import Places
from shared.mapgraph.edge_ends import edge_between
from shared.messages.features import Features
from shared.messages.maps import Edge, Node
from shared.messages.matching import NodeMatch

PIPELINE = "standin/1"
KEYPOINTS = 500
REACH_M = 1.7
"""Places of one map this near are connected."""

SEEN_M = 1.5
"""Places of two maps this near have enough verified matches."""


@dataclass(frozen=True)
class Pose:
    """Where a picture was taken: metres and radians in the plane."""

    x_m: float
    y_m: float
    yaw_rad: float

    def moved(self, x_m: float, y_m: float) -> "Pose":
        """The pose elsewhere, turned the same way."""
        return Pose(self.x_m + x_m, self.y_m + y_m, self.yaw_rad)


def row(rng: np.random.Generator, first_x_m: float, y_m: float, count: int) -> list[Pose]:
    """Places about 1 m apart along a street, each turned as it came."""
    return [
        Pose(first_x_m + k + rng.uniform(-0.1, 0.1), y_m + rng.uniform(-0.1, 0.1), rng.uniform(-3.1, 3.1))
        for k in range(count)
    ]


def seen(first: Pose, second: Pose) -> tuple[float, float]:
    """Direction and turn of `second` as seen from `first`, radians, camera frame of `first`."""
    way_rad = math.atan2(second.y_m - first.y_m, second.x_m - first.x_m)
    return wrap(way_rad - first.yaw_rad), wrap(second.yaw_rad - first.yaw_rad)


def edges_of(poses: Mapping[int, Pose], rng: np.random.Generator, error_rad: float = 0.0) -> list[Edge]:
    """Connections between places in reach of one another, measured with an error."""
    edges = []
    for a, b in ((a, b) for a in poses for b in poses if a < b and apart_m(poses[a], poses[b]) < REACH_M):
        heading, yaw = (wrap(angle + rng.normal(0.0, error_rad)) for angle in seen(poses[a], poses[b]))
        edges.append(Edge.model_validate({**edge_between(a, b, heading, yaw), "inliers": 80, "why": "seen"}))
    return edges


def map_of(poses: Mapping[int, Pose], rng: np.random.Generator, error_rad: float = 0.0) -> Places:
    """A map of these places."""
    nodes = [Node(node_id=n, stamp_ns=1_000 + n, pipeline=PIPELINE, keypoints=KEYPOINTS) for n in poses]
    return Places(nodes, edges_of(poses, rng, error_rad))


def match(
    base_id: int, frame: Pose, place: Pose, rng: np.random.Generator, error_rad: float = 0.0
) -> NodeMatch:
    """What matching says of a picture at `frame` and a place at `place`; fewer agree the further apart."""
    heading, yaw = (wrap(angle + rng.normal(0.0, error_rad)) for angle in seen(frame, place))
    near = apart_m(frame, place) < 0.05
    return NodeMatch(
        node_id=base_id,
        raw_matches=200,
        inliers=round(200 - 90 * apart_m(frame, place)),
        status="no_baseline" if near else "ok",
        heading_rad=None if near else heading,
        yaw_rad=yaw,
        confidence=0.0 if near else 0.9,
        disparity_rad=0.15 * apart_m(frame, place),
    )


def matches_of(
    base: Mapping[int, Pose],
    other: Mapping[int, Pose],
    rng: np.random.Generator,
    error_rad: float = 0.0,
    shift_m: tuple[float, float] = (0.0, 0.0),
) -> dict[int, list[NodeMatch]]:
    """Matches of every place of `other` with those of `base` in sight; best 5.

    Args:
        base: places that are searched.
        other: places looked for.
        rng: draws the errors.
        error_rad: standard deviation of directions and turns.
        shift_m: where `other` seems to be, beside where it is: look-alikes there.
    """
    found = {}
    for place, pose in other.items():
        there = pose.moved(*shift_m)
        near = [match(n, there, at, rng, error_rad) for n, at in base.items() if apart_m(there, at) < SEEN_M]
        found[place] = sorted(near, key=lambda m: -m.inliers)[:5]
    return found


def together(*found: Mapping[int, Iterable[NodeMatch]]) -> dict[int, list[NodeMatch]]:
    """All these matches."""
    return {place: [m for one in found for m in one.get(place, ())] for one in found for place in one}


def features_of(number: int) -> Features:
    """Small features that can be told apart by their number, with a thumbnail."""
    rng = np.random.default_rng(number)
    return Features(
        seq=number,
        pipeline=PIPELINE,
        lonlat_rad=rng.random((4, 2), dtype=np.float32),
        scores=rng.random(4, dtype=np.float32),
        descriptors=rng.random((4, 8), dtype=np.float32),
        thumbnail=b"\xff\xd8 picture %d" % number,
    )


def apart_m(first: Pose, second: Pose) -> float:
    """Distance of two poses."""
    return math.hypot(first.x_m - second.x_m, first.y_m - second.y_m)


def wrap(angle_rad: float) -> float:
    """The angle within half a turn."""
    return math.remainder(angle_rad, math.tau)
