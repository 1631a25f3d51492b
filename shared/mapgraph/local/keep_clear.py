"""Whether a straight way comes near nodes that are forbidden, by where the edges put them. Pure."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from shared.mapgraph.frontiers import sector_rad
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.relative_poses import RelativePose, relative_poses
from shared.mapgraph.local.view_range import openness
from shared.mapgraph.rules import NO_LIMITS, Clock, Limits, limits_at
from shared.messages.base import SECTORS

FloatArray = npt.NDArray[np.float64]

CLEAR_M = 0.6
"""Distance that a way keeps from a forbidden node in a room; chosen: a bit more than half of the way between
two nodes there, so that none fits between those of an area."""
REACH_M = 1.5
"""So far a departure leads in a room before there is a new node, at most; chosen: twice the way of two."""
TOUCH_SHARE = 0.95
"""Of the distance that either end has anyway: a way along an area is none into it; chosen."""


@dataclass(frozen=True)
class KeepClear:
    """Spots that ways keep clear of, around one node.

    Attributes:
        poses: of the nodes around it, in its camera frame.
        spots_m: (K, 2) of the forbidden ones, likewise.
        clear_m: distance to keep.
    """

    poses: dict[int, RelativePose]
    spots_m: FloatArray
    clear_m: float

    def is_crossed(self, start_m: Sequence[float] | FloatArray, end_m: Sequence[float] | FloatArray) -> bool:
        """Whether the way between two points (2,) comes nearer to a spot than it may and its start is."""
        return bool((self._nearest(start_m, end_m) < self._least(start_m)).any())

    def is_crossed_to(self, start_m: Sequence[float] | FloatArray, node_id: int) -> bool:
        """Whether the way to a node that is allowed crosses: it may end as near to a spot as the node is."""
        if node_id not in self.poses:
            return False
        end_m = self.poses[node_id].position_m
        least_m = np.minimum(self._least(start_m), self._least(end_m))
        return bool((self._nearest(start_m, end_m) < least_m).any())

    def _least(self, point_m: Sequence[float] | FloatArray) -> FloatArray:
        away_m = np.linalg.norm(self.spots_m - np.asarray(point_m), axis=1)
        return np.asarray(np.minimum(self.clear_m, TOUCH_SHARE * away_m))

    def _nearest(
        self, start_m: Sequence[float] | FloatArray, end_m: Sequence[float] | FloatArray
    ) -> FloatArray:
        """(K,) distance of each spot from the way."""
        start, along = np.asarray(start_m, dtype=float), np.asarray(end_m, dtype=float) - np.asarray(start_m)
        share = (self.spots_m - start) @ along / max(float(along @ along), 1e-12)
        feet = start + np.clip(share, 0.0, 1.0)[:, None] * along
        return np.asarray(np.linalg.norm(self.spots_m - feet, axis=1))


def keep_clear(graph: MapGraph, root: int, forbidden: Collection[int]) -> KeepClear | None:
    """What ways around a node keep clear of; None where no forbidden node is among those around it."""
    around = graph.nearest(root, NEAR_NODES)
    if not any(node in forbidden for node in around):
        return None
    poses = relative_poses(graph, root, around, NEAR_NODES)
    spots = [pose.position_m for node, pose in poses.items() if node in forbidden]
    return KeepClear(poses, np.array(spots).reshape(-1, 2), CLEAR_M * openness(graph, root))


def current_limits(graph: MapGraph, clock: Clock) -> Limits:
    """What the rules of a map say, and the edges and directions that lead too near to what they forbid.

    Reckoned once a minute, and anew when the map changes.

    Args:
        graph: the map.
        clock: the minute asked about.
    """
    if not graph.rules:
        return NO_LIMITS
    return graph.made_once(("limits", clock.minute), lambda: _limits(graph, clock))


def _limits(graph: MapGraph, clock: Clock) -> Limits:
    said = limits_at(graph.places, graph.rules.values(), clock)
    if not said.forbidden:
        return said
    key = ("barred", frozenset(said.forbidden.items()))
    barred = graph.made_once(key, lambda: _barred(graph, said.forbidden))
    return replace(said, closed={**barred.edges, **said.closed}, directions=barred.directions)


class _Barred(NamedTuple):
    """What leads too near to forbidden nodes: edges between allowed ones, both ways, and directions."""

    edges: dict[tuple[int, int], str]
    directions: dict[int, frozenset[int]]


def _barred(graph: MapGraph, forbidden: Mapping[int, str]) -> _Barred:
    """Each forbidden node that an edge joins to an allowed one knows best what lies around it."""
    edges: dict[tuple[int, int], str] = {}
    directions: dict[int, frozenset[int]] = {}
    for root in sorted(forbidden):
        if root not in graph.nodes or not set(graph.neighbours(root)) - forbidden.keys():
            continue
        around = keep_clear(graph, root, (root,))
        assert around is not None
        reach_m = REACH_M * openness(graph, root)
        allowed = [node for node in around.poses if node not in forbidden]
        for edge in graph.edges_among(allowed):
            if around.is_crossed_to(around.poses[edge.a].position_m, edge.b):
                edges |= {way: forbidden[root] for way in ((edge.a, edge.b), (edge.b, edge.a))}
        for node in allowed:
            found = _directions(around, node, reach_m)
            if found:
                directions[node] = directions.get(node, frozenset()) | found
    return _Barred(edges, directions)


def _directions(around: KeepClear, node: int, reach_m: float) -> frozenset[int]:
    """Sectors of a node by which a departure of so many metres comes too near to a spot."""
    pose = around.poses[node]
    if np.linalg.norm(around.spots_m - pose.position_m, axis=1).min() > reach_m + around.clear_m:
        return frozenset()
    angles_rad = pose.yaw_rad + np.array([sector_rad(sector) for sector in range(SECTORS)])
    ends_m = pose.position_m + reach_m * np.stack([np.cos(angles_rad), np.sin(angles_rad)], axis=1)
    return frozenset(s for s, end_m in enumerate(ends_m) if around.is_crossed(pose.position_m, end_m))


def is_near_forbidden(graph: MapGraph, here: Displacement | None, forbidden: Collection[int]) -> bool:
    """Whether a forbidden node is among those around the robot; without knowing where it is, one may be."""
    if not forbidden or here is None or here.node_id not in graph.nodes:
        return bool(forbidden)
    return any(node in forbidden for node in graph.nearest(here.node_id, NEAR_NODES))


def clear_nodes(
    graph: MapGraph, here: Displacement | None, nodes: Collection[int], forbidden: Collection[int]
) -> list[int]:
    """Those nodes to which the straight way from the robot keeps clear of forbidden ones.

    Args:
        graph: the map.
        here: where the robot is; None where nobody knows: then nothing is known of ways either.
        nodes: allowed ones in sight.
        forbidden: nodes not to come near.
    """
    if not forbidden or here is None or here.node_id not in graph.nodes:
        return list(nodes)
    around = keep_clear(graph, here.node_id, forbidden)
    if around is None:
        return list(nodes)
    return [node for node in nodes if not around.is_crossed_to((here.x_m, here.y_m), node)]
