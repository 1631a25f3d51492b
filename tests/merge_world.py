"""Spots on a plane with known poses: maps of them, and what matching two such maps finds."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest

from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.merging.candidates import Candidate
from shared.mapgraph.merging.sight_graph import SightGraph
from shared.messages.features import Features
from shared.messages.maps import Edge, Node
from shared.messages.matching import NodeMatch

PIPELINE = "standin/1"
KEYPOINTS = 500
REACH_M = 1.7
"""Nodes of one map this near have an edge."""

SEEN_M = 1.5
"""Nodes of two maps this near have enough verified matches."""

ERROR_RAD = math.radians(2.0)
"""Standard deviation of bearings and yaws in `Streets`."""

STREET_M = 60.0
"""The far street of `Streets` lies so far beside the true one."""

Matches = dict[int, list[NodeMatch]]
"""By node of the other map."""


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
    """Poses about 1 m apart along a street, each turned as it came."""
    return [
        Pose(first_x_m + k + rng.uniform(-0.1, 0.1), y_m + rng.uniform(-0.1, 0.1), rng.uniform(-3.1, 3.1))
        for k in range(count)
    ]


def seen(first: Pose, second: Pose) -> tuple[float, float]:
    """Direction and turn of `second` as seen from `first`, radians, camera frame of `first`."""
    way_rad = math.atan2(second.y_m - first.y_m, second.x_m - first.x_m)
    return wrap(way_rad - first.yaw_rad), wrap(second.yaw_rad - first.yaw_rad)


def edges_of(poses: Mapping[int, Pose], rng: np.random.Generator, error_rad: float = 0.0) -> list[Edge]:
    """Edges between nodes in reach of one another, measured with an error."""
    edges = []
    for a, b in ((a, b) for a in poses for b in poses if a < b and apart_m(poses[a], poses[b]) < REACH_M):
        heading, yaw = (wrap(angle + rng.normal(0.0, error_rad)) for angle in seen(poses[a], poses[b]))
        edges.append(Edge.model_validate({**edge_between(a, b, heading, yaw), "inliers": 80, "why": "seen"}))
    return edges


def map_of(poses: Mapping[int, Pose], rng: np.random.Generator, error_rad: float = 0.0) -> SightGraph:
    """A map of these poses."""
    nodes = [Node(node_id=n, stamp_ns=1_000 + n, pipeline=PIPELINE, keypoints=KEYPOINTS) for n in poses]
    return SightGraph(nodes, edges_of(poses, rng, error_rad))


def match(
    base_id: int, frame: Pose, node: Pose, rng: np.random.Generator, error_rad: float = 0.0
) -> NodeMatch:
    """What matching says of a picture at `frame` and a node at `node`; fewer agree the further apart."""
    heading, yaw = (wrap(angle + rng.normal(0.0, error_rad)) for angle in seen(frame, node))
    near = apart_m(frame, node) < 0.05
    return NodeMatch(
        node_id=base_id,
        raw_matches=200,
        inliers=round(200 - 90 * apart_m(frame, node)),
        status="no_baseline" if near else "ok",
        heading_rad=None if near else heading,
        yaw_rad=yaw,
        confidence=0.0 if near else 0.9,
        disparity_rad=0.15 * apart_m(frame, node),
    )


def matches_of(
    base: Mapping[int, Pose],
    other: Mapping[int, Pose],
    rng: np.random.Generator,
    error_rad: float = 0.0,
    shift_m: tuple[float, float] = (0.0, 0.0),
) -> Matches:
    """Matches of every node of `other` with those of `base` in sight; best 5.

    Args:
        base: nodes that are searched.
        other: nodes looked for.
        rng: draws the errors.
        error_rad: standard deviation of directions and turns.
        shift_m: where `other` seems to be, beside where it is: look-alikes there.
    """
    found = {}
    for node, pose in other.items():
        there = pose.moved(*shift_m)
        near = [match(n, there, at, rng, error_rad) for n, at in base.items() if apart_m(there, at) < SEEN_M]
        found[node] = sorted(near, key=lambda m: -m.inliers)[:5]
    return found


def together(*found: Mapping[int, Iterable[NodeMatch]]) -> Matches:
    """All these matches."""
    return {node: [m for one in found for m in one.get(node, ())] for one in found for node in one}


def assert_points(edge: Edge, poses: Mapping[int, Pose]) -> None:
    """The edge says where its ends are, within the errors of `Streets`."""
    heading_rad, yaw_rad = seen(poses[edge.a], poses[edge.b])
    back_rad, _ = seen(poses[edge.b], poses[edge.a])
    told = edge.yaw_ab_rad, edge.heading_ab_rad, edge.heading_ba_rad
    for angle_rad, true_rad in zip(told, (yaw_rad, heading_rad, back_rad), strict=True):
        assert angle_rad is not None
        assert wrap(angle_rad - true_rad) == pytest.approx(0.0, abs=6 * ERROR_RAD)


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


class Streets:
    """A base map of one street and a far equal one, joined by a long way, and another map of the first.

    Nodes 0 to 11 are the street, 12 to 23 the equal one; `other` overlaps the second half of the first.
    """

    def __init__(self, seed: int) -> None:
        self.rng = rng = np.random.default_rng(seed)
        street = row(rng, 0.0, 0.0, 12)
        self.base = dict(enumerate(street + [pose.moved(0.0, STREET_M) for pose in street]))
        way = [pose for k in range(1, 60) for pose in row(rng, 11.0, float(k), 1)]
        self.base |= {24 + k: pose for k, pose in enumerate(way)}
        self.other = {3 * k + 1: pose for k, pose in enumerate(row(rng, 6.3, 0.35, 12))}
        self.base_map = map_of(self.base, rng, ERROR_RAD)
        self.other_map = map_of(self.other, rng, ERROR_RAD)

    def true_matches(self) -> Matches:
        """What matching finds of the street that both maps share."""
        return matches_of(self.base, self.other, self.rng, ERROR_RAD)

    def look_alikes(self, count: int) -> Matches:
        """The first nodes of `other` look like the far street as well."""
        some = {n: self.other[n] for n in sorted(self.other)[:count]}
        return matches_of(self.base, some, self.rng, ERROR_RAD, (0.0, STREET_M))

    def wrong(self, chosen: Iterable[Candidate]) -> list[Candidate]:
        """Those of `chosen` that join two different spots."""
        return [one for one in chosen if apart_m(self.base[one.base], self.other[one.other]) > 2.0]
