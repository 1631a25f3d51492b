"""The order in which frontiers are visited: much floor early, on short ways. Pure.

Nearest first leaves a far corner to the end, most floor first leaves small rests everywhere. Floor costs by
how late it comes, so that order is sought in which the metres driven before each frontier, weighted by its
floor, sum up to the least: the minimum latency problem (Blum et al., 1994), or that of the travelling
repairman. That a tour of all of them tells the next goal is from Kulich, Faigl and Preucil, "On distance
utility in the exploration task" (ICRA 2011).
"""

from collections.abc import Iterable, Mapping
from functools import cache

import networkx as nx
import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.intp]

ORDERED = 40
"""Nearest frontiers put in order; chosen: a tenth of a second, and more than lie around one place."""
MOVED_TOGETHER = 3
"""Up to so many neighbours of an order are moved elsewhere in it (or-opt); the usual number."""
NO_WAY_M = 1e6
"""Between places where the way is closed in one direction; chosen: more than all ways of a map together."""
SHORTER_M = 1e-9
"""An order must be better by more than this, which is less than rounding makes of equal ones."""


def first_to_visit(ways: "nx.Graph[int]", start: int, gains: Mapping[int, float]) -> int | None:
    """The node to go to next; None where no way leads to any.

    Args:
        ways: between the nodes of the map, of `shared.mapgraph.routing.open_ways`.
        start: where the robot is.
        gains: the nodes to visit, with the floor that each leads to, in any unit.
    """
    if start in gains:
        return start
    if start not in ways:
        return None
    there_m = _ways_m(ways, start)
    nodes = sorted(gains.keys() & there_m.keys(), key=lambda node: (there_m[node], node))[:ORDERED]
    if len(nodes) < 2:
        return next(iter(nodes), None)
    ways_m = [there_m, *(_ways_m(ways, node) for node in nodes)]
    apart_m = np.array([[of_one.get(node, NO_WAY_M) for node in (start, *nodes)] for of_one in ways_m])
    return nodes[first_of(apart_m, np.array([gains[node] for node in nodes]))]


def first_of(apart_m: FloatArray, gains: FloatArray) -> int:
    """Which of the places comes first in the order of least metres before each, weighted by gains.

    Nearest next, improved by turning parts of the order round (2-opt) and by moving some places elsewhere
    (or-opt): the best move at a time, as long as one makes it better.

    Args:
        apart_m: (N + 1, N + 1) ways from the start and from each place to each.
        gains: (N,) of the places.
    """
    weights = np.array([0.0, *gains])
    order = _nearest_next(apart_m)
    best_m = _waited_m(order[None], apart_m, weights)[0]
    while True:
        orders = order[_moves(len(order))]
        waited_m = _waited_m(orders, apart_m, weights)
        chosen = int(waited_m.argmin())
        if waited_m[chosen] >= best_m - SHORTER_M:
            return int(order[1]) - 1
        order, best_m = orders[chosen], waited_m[chosen]


def _ways_m(ways: "nx.Graph[int]", start: int) -> dict[int, float]:
    metres: dict[int, float] = nx.single_source_dijkstra_path_length(ways, start)
    return metres


def _nearest_next(apart_m: FloatArray) -> IndexArray:
    order, left = [0], set(range(1, len(apart_m)))
    while left:
        order.append(min(left, key=lambda place: (apart_m[order[-1], place], place)))
        left.remove(order[-1])
    return np.array(order)


def _waited_m(orders: IndexArray, apart_m: FloatArray, weights: FloatArray) -> FloatArray:
    """(K,) sum of the metres before each place times its weight, for orders (K, N + 1)."""
    driven_m = np.cumsum(apart_m[orders[:, :-1], orders[:, 1:]], axis=1)
    return np.asarray((weights[orders[:, 1:]] * driven_m).sum(axis=1))


@cache
def _moves(count: int) -> IndexArray:
    """(M, count) orders one move away from 0, 1, 2 ..., of which 0 stays first."""
    return np.array(list(_turned(range(count))) + list(_moved(range(count))))


def _turned(order: range) -> Iterable[list[int]]:
    for first in order[1:]:
        for last in order[first + 1 :]:
            yield [*order[:first], *reversed(order[first : last + 1]), *order[last + 1 :]]


def _moved(order: range) -> Iterable[list[int]]:
    for size in range(1, MOVED_TOGETHER + 1):
        for first in range(1, len(order) - size + 1):
            part, rest = order[first : first + size], [*order[:first], *order[first + size :]]
            yield from ([*rest[:at], *part, *rest[at:]] for at in range(1, len(rest) + 1) if at != first)
