"""Which matches between two maps are worth a test. Pure.

Throughout this package `base` is the map that grows, `other` the one whose nodes it gets.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.triangle import Sight
from shared.messages.maps import Node
from shared.messages.matching import NodeMatch

CONFIDENCE_MIN = 0.5
"""Below it the two directions of a motion are too alike to tell; exploration asks as much of an edge."""

INLIERS_MIN = 45
"""Inliers below which perceptual aliasing explains a match as well: `s_sure` of the default profile."""

NEAR_SHARE = 0.25
"""Share of the keypoints that agree where one robot stood nearly where the other did. Of 218 aliased matches
of parts of a village that share no spot one reached 0.24, one 0.22, and the others 0.15 at most."""


class MergeRefusedError(ValueError):
    """The maps cannot be merged; the text says why, for people."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A node of the other map that looks like a node of the base map. Equal only to itself.

    Attributes:
        other: the node of the other map, whose features were matched.
        base: the node of the base map.
        match: what matching found; bearings in the camera frame of `other`.
        near: so much agrees that one robot nearly stood where the other did.
    """

    other: int
    base: int
    match: NodeMatch
    near: bool

    @property
    def sight(self) -> Sight:
        """`base` seen from `other`."""
        return Sight(self.match.heading_rad, self.match.yaw_rad)

    @property
    def yaw_rad(self) -> float:
        """Rotation from the camera of `other` to that of `base`; candidates always have it."""
        assert self.match.yaw_rad is not None
        return self.match.yaw_rad

    @property
    def back(self) -> Sight:
        """`other` seen from `base`."""
        heading_rad = self.match.heading_rad
        back_rad = None if heading_rad is None else heading_rad + math.pi - self.yaw_rad
        return Sight(back_rad, -self.yaw_rad)


def candidates_of(
    base: MapGraph, other: MapGraph, matches: Mapping[int, Iterable[NodeMatch]]
) -> list[Candidate]:
    """The matches that can be trusted one by one.

    Args:
        base: the map that was searched.
        other: the map whose nodes were looked for.
        matches: by node of `other`.
    """
    return [
        Candidate(node, match.node_id, match, _is_near(match, base.nodes[match.node_id], other.nodes[node]))
        for node, found in sorted(matches.items())
        for match in found
        if node in other.nodes and match.node_id in base.nodes and is_sure(match)
    ]


def is_sure(match: NodeMatch) -> bool:
    """Whether enough agrees. A match without a baseline has no bearing, so no confidence in one either."""
    if match.yaw_rad is None or match.inliers < INLIERS_MIN:
        return False
    if match.status == "no_baseline":
        return True
    return match.status == "ok" and match.heading_rad is not None and match.confidence >= CONFIDENCE_MIN


def _is_near(match: NodeMatch, first: Node, second: Node) -> bool:
    return match.inliers >= NEAR_SHARE * min(first.keypoints, second.keypoints)
