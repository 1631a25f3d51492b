"""Matches with the nodes of a grid map, and the ports that a tracker or a goal needs."""

import math

import numpy as np

from shared.mapgraph.routing import GOAL
from shared.messages.features import Features
from shared.messages.matching import NodeMatch
from tests.unit.shared.mapgraph.local.grid import GRID_HALF_M, claim
from tests.unit.shared.mapgraph.local.places import inliers_at


def match(node, x_m, y_m, inliers=None):
    """A node seen so far ahead and to the left, from a camera that looks along x.

    Without a number of its own it has as many matches as nodes so far apart have in the grid.
    """
    inliers = inliers_at(math.hypot(x_m, y_m), GRID_HALF_M) if inliers is None else inliers
    sight = claim(x_m, y_m, inliers)
    return NodeMatch(
        node_id=node, raw_matches=inliers + 20, inliers=inliers,
        status="ok" if sight.heading_rad is not None else "no_baseline", confidence=0.9,
        heading_rad=sight.heading_rad, heading_std_rad=0.01, yaw_rad=0.0, disparity_rad=0.15 * sight.length_m,
    )  # fmt: skip


def by_node(*matches):
    return {one.node_id: one for one in matches}


def features(seq=0):
    empty = np.zeros((0, 2), np.float32)
    return Features(
        seq=seq, robot="r1", pipeline="p", lonlat_rad=empty, scores=empty[:, 0], descriptors=empty
    )


class Maps:
    def __init__(self, graph):
        self.graph = graph

    def commit(self, operations):
        self.graph.apply(operations)


class Matcher:
    """Compares a frame with the one before it: they resemble one another by so many matches.

    Of nodes it sees those of `near`. The frame before was taken from the same spot, or a little behind it
    in a direction known that well.
    """

    def __init__(self, inliers=200, near=()):
        self.inliers, self.near, self.heading_std_rad = inliers, near, None

    def match(self, node_ids, best_k=0, targets=()):  # noqa: ARG002
        nodes = {node: match(node, 0.2, 0.0) for node in node_ids if node in self.near}
        if not targets:
            return nodes
        moved_m = 0.0 if self.heading_std_rad is None else 0.2
        before = match(GOAL, -moved_m, 0.0, self.inliers)
        return {**nodes, GOAL: before.model_copy(update={"heading_std_rad": self.heading_std_rad})}
