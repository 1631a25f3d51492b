"""Edges of a part of the map as measurements: direction, yaw, and how long they are. Pure."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import edge_length_m
from shared.messages.maps import Edge

DRIVEN_SHARE = 0.1
DRIVEN_M = 0.08
"""A driven length is good to 10 % and 8 cm from node to node, if its edge does not say less: wheels slip, and
what is common to all of them is scale, which bearings leave open anyway."""

SEEN_SHARE = 3.0
SEEN_M = 2.0
"""A length by matches is a guess that only keeps the solution finite: those of one place are too long or too
short together, and many wrong ones would outweigh what bearings and driven lengths say."""

SPOT_M = 0.3
"""Two nodes without a baseline lie this near."""


@dataclass(frozen=True)
class LocalSight:
    """One edge, its ends numbered within the part of the map.

    Attributes:
        bearing_rad: of b in a's frame; None where both are one spot.
        yaw_rad: of b's camera in a's frame.
        length_m: about how far; spread_m: one standard deviation.
        driven: whether the robot went along it.
    """

    a: int
    b: int
    bearing_rad: float | None
    yaw_rad: float
    length_m: float
    spread_m: float
    driven: bool

    def direction(self, yaw_rad: float) -> npt.NDArray[np.float64]:
        """Unit vector from a to b, with a's camera turned by `yaw_rad`."""
        angle_rad = yaw_rad + (self.bearing_rad or 0.0)
        return np.array([math.cos(angle_rad), math.sin(angle_rad)])


def sights_among(graph: MapGraph, index: Mapping[int, int]) -> list[LocalSight]:
    """The edges between the nodes of `index` that may be used and have a yaw.

    Args:
        graph: the map.
        index: number of each node within the part.
    """
    among = graph.edges_among(index)
    return [_sight(graph, edge, index) for edge in among if edge.yaw_ab_rad is not None]


def _sight(graph: MapGraph, edge: Edge, index: Mapping[int, int]) -> LocalSight:
    bearing_rad, yaw_rad = edge.heading_ab_rad, edge.yaw_ab_rad or 0.0
    length_m = edge_length_m(graph, edge)
    if edge.length_m is not None:
        rough_m = DRIVEN_SHARE * length_m + DRIVEN_M
        spread_m = rough_m if edge.length_std_m is None else max(edge.length_std_m, rough_m)
    elif bearing_rad is None or edge.disparity_rad is None:
        length_m, spread_m = 0.0, SPOT_M
    else:
        spread_m = SEEN_SHARE * length_m + SEEN_M
    driven = edge.length_m is not None
    return LocalSight(index[edge.a], index[edge.b], bearing_rad, yaw_rad, length_m, spread_m, driven)
