"""Where the nodes around one lie, from bearings, yaws and driven lengths: a pose graph in the plane. Pure.

Bearings between nodes fix the shape of a map up to its scale (parallel rigidity); lengths that the robot
drove give the scale, and hold together what no third node sees. Yaws are solved first, then positions are
linear: for an edge with unit direction u and normal n in the root's frame

    n . (p_b - p_a) = 0 +- bearing error times length,    u . (p_b - p_a) = length +- length error,

by least squares with Cauchy weights, so that a wrong edge bends little. The inverse of the normal matrix is
the covariance of the positions relative to the root.
"""

from collections import deque
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.differences import Differences
from shared.mapgraph.local.sights import LocalSight, sights_among

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.intp]
Tree = Sequence[tuple[LocalSight, bool]]

BEARING_RAD = float(np.deg2rad(1.5))
"""Error of an edge's bearing; of true edges 99 % are within 2 degrees (`topnav explore`)."""
YAW_RAD = float(np.deg2rad(0.7))
"""Error of an edge's yaw; triangles of true edges miss by 1.1 degrees at most."""
POINT_M = 0.05
"""What no position is better than: nodes are pictures of a robot that moves."""
ROUNDS = 3
"""Of reweighting; the answer then moves by centimetres."""
CAUCHY = 3.0
"""Standard deviations at which a measurement counts half: the usual scale of Cauchy weights."""
INVERTED_NODES = 64
"""Of a part with no more nodes all covariances are reckoned at once, and kept: a frame asks for some of them
five times. In a larger one those few that are asked for cost less."""


@dataclass(frozen=True)
class RelativePose:
    """A node as from the root.

    Attributes:
        position_m: (2,) in the root's camera frame, x ahead, y left.
        covariance_m2: (2, 2) of the position.
        yaw_rad: of the node's camera in the root's frame; yaw_std_rad: its error.
    """

    position_m: FloatArray
    covariance_m2: FloatArray
    yaw_rad: float
    yaw_std_rad: float


def relative_poses(graph: MapGraph, root: int, wanted: Collection[int], most: int) -> dict[int, RelativePose]:
    """Poses of the wanted nodes that edges join to `root`.

    Args:
        graph: the map; suspended edges do not count.
        root: the node to start from.
        wanted: whose poses are asked for; those out of the part reckoned with are left out.
        most: nodes to reckon with, nearest by number of edges first.
    """
    part = graph.made_once(("local part", root, most), lambda: _solved(graph, graph.nearest(root, most)))
    return _poses(part, wanted)


def poses_by_ways(graph: MapGraph, root: int, wanted: Collection[int]) -> dict[int, RelativePose]:
    """Poses of the wanted nodes that edges join to `root`, however far off, by the ways that lead there.

    Reckoned with the nodes of one way to each, rather over driven edges than over seen ones, and their
    neighbours: less certain than with the whole map, in which other ways hold them in place, too.
    """
    ways = [way for node in sorted(set(wanted)) if (way := graph.way(root, node))]
    if not ways:
        return {}
    beside = dict.fromkeys(node for way in ways for node in way)
    beside |= dict.fromkeys(node for way in ways for on in way for node in sorted(graph.neighbours(on)))
    return _poses(_solved(graph, [root, *(node for node in beside if node != root)]), wanted)


def _poses(part: "_Part", wanted: Collection[int]) -> dict[int, RelativePose]:
    asked = sorted(node for node in set(wanted) if node in part.index)
    rows = np.array([part.index[node] for node in asked], dtype=np.intp)
    covariance_m2, variance = part.positions.covariance(rows), part.yaws.covariance(rows)
    yaw_std_rad = np.sqrt(np.maximum(variance[:, 0, 0], 0.0))
    return {
        node: RelativePose(
            part.positions.values[row],
            covariance_m2[k],
            float(part.yaws.values[row, 0]),
            float(yaw_std_rad[k]),
        )
        for k, (node, row) in enumerate(zip(asked, rows, strict=True))
    }


@dataclass(frozen=True)
class _Solution:
    """Values (N, D) of the nodes of a part, and the equations they come from; none without an edge."""

    values: FloatArray
    equations: Differences | None = None
    weight: FloatArray | None = None

    def covariance(self, rows: IndexArray) -> FloatArray:
        """(K, D, D) of some nodes relative to the first."""
        if self.equations is None or self.weight is None:
            size = self.values.shape[1]
            return np.zeros((len(rows), size, size))
        if len(self.values) <= INVERTED_NODES:
            return self._all[rows]
        return self.equations.covariance(self.weight, rows)

    @cached_property
    def _all(self) -> FloatArray:
        assert self.equations is not None
        assert self.weight is not None
        return self.equations.covariance(self.weight, np.arange(len(self.values)))


@dataclass(frozen=True)
class _Part:
    """The nodes around a root, numbered."""

    index: dict[int, int]
    yaws: _Solution
    positions: _Solution


def _solved(graph: MapGraph, order: Sequence[int]) -> _Part:
    """The part of the map with these nodes, as from the first."""
    index = {node: i for i, node in enumerate(order)}
    sights = sights_among(graph, index)
    tree = _tree(len(order), sights)
    yaws = _solve_yaws(len(order), sights, tree)
    return _Part(index, yaws, _solve_positions(len(order), sights, tree, yaws.values[:, 0]))


def _solve_yaws(count: int, sights: Sequence[LocalSight], tree: Tree) -> _Solution:
    """Yaw of each node relative to the first."""
    yaws = np.zeros((count, 1))
    for sight, forward in tree:
        known, new = (sight.a, sight.b) if forward else (sight.b, sight.a)
        yaws[new] = yaws[known] + (sight.yaw_rad if forward else -sight.yaw_rad)
    if not sights:
        return _Solution(yaws)
    equations = Differences(_ends(sights), np.ones((len(sights), 1)), count)
    measured, weight = np.array([s.yaw_rad for s in sights]), np.ones(len(sights))
    for _ in range(ROUNDS):
        residual = np.remainder(measured - equations.of(yaws) + np.pi, 2.0 * np.pi) - np.pi
        weight = cauchy(residual / YAW_RAD) / YAW_RAD**2
        yaws = yaws + equations.step(weight, residual)
    return _Solution(yaws, equations, weight)


def _solve_positions(count: int, sights: Sequence[LocalSight], tree: Tree, yaws: FloatArray) -> _Solution:
    """(N, 2) positions in the frame of the first node."""
    places = np.zeros((count, 2))
    for sight, forward in tree:
        step = sight.length_m * sight.direction(yaws[sight.a])
        known, new = (sight.a, sight.b) if forward else (sight.b, sight.a)
        places[new] = places[known] + (step if forward else -step)
    if not sights:
        return _Solution(places)
    ends, along = _ends(sights), np.stack([s.direction(yaws[s.a]) for s in sights])
    length, spread = np.array([s.length_m for s in sights]), np.array([s.spread_m for s in sights])
    blind = np.array([s.bearing_rad is None for s in sights])
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    equations = Differences(np.tile(ends, (2, 1)), np.concatenate([across, along]), count)
    wanted, weight = np.concatenate([np.zeros(len(sights)), length]), np.ones(2 * len(sights))
    for _ in range(ROUNDS):
        apart = np.maximum(np.linalg.norm(places[ends[:, 1]] - places[ends[:, 0]], axis=1), length)
        aside = np.where(blind, spread, np.hypot(BEARING_RAD * apart, POINT_M))
        residual, scale = wanted - equations.of(places), np.concatenate([aside, spread])
        weight = cauchy(residual / scale) / scale**2
        places = places + equations.step(weight, residual)
    return _Solution(places, equations, weight)


def _ends(sights: Sequence[LocalSight]) -> IndexArray:
    return np.array([(s.a, s.b) for s in sights], dtype=np.intp)


def _tree(count: int, sights: Sequence[LocalSight]) -> Tree:
    """Sights that reach every node from the first one; True where one leads from a to b.

    Along what was driven before what was only seen: a robot does not drive a wrong edge.
    """
    of: list[list[tuple[LocalSight, bool]]] = [[] for _ in range(count)]
    for sight in sights:
        of[sight.a].append((sight, True))
        of[sight.b].append((sight, False))
    reached, found, waiting = {0}, [], deque(of[0])
    while waiting:
        sight, forward = waiting.popleft()
        new = sight.b if forward else sight.a
        if new in reached:
            continue
        reached.add(new)
        found.append((sight, forward))
        for onward in of[new]:
            (waiting.appendleft if onward[0].driven else waiting.append)(onward)
    return found


def cauchy(residual: FloatArray) -> FloatArray:
    """Weights of residuals, in standard deviations."""
    return np.asarray(1.0 / (1.0 + (residual / CAUCHY) ** 2), dtype=np.float64)
