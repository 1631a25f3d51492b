"""What a picture claims of a node: where it lies and how its camera is turned. Pure."""

import math
from dataclasses import dataclass

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import length_to_m
from shared.messages.matching import NodeMatch

CONFIDENCE_MIN = 0.5
"""Below it a match claims no edge and no place: its two directions explain it equally well."""

NEAR_RAD_PER_M = math.radians(2.25)
"""Bearings of what is near change at least so fast on the way to a node: a quarter of what they do in a room,
a third of what they do in a yard. What clouds and a skyline do: 0.3 to 1.7 degrees for each metre that their
matches stand for."""
NEAR_M = 0.5
"""Whoever shares so many matches with a node as from half a metre away is near it, whatever moves; chosen."""


@dataclass(frozen=True)
class Claim:
    """One sight of a node.

    Attributes:
        similarity: S of the two.
        heading_rad: bearing of the node, camera frame of the picture; None where both are one spot.
        heading_std_rad: its error.
        yaw_rad: rotation from the picture's camera to the node's.
        length_m: rough distance of the node, by how much the two have in common.
        is_near: what the two have in common moves as things near by do. What is far away agrees with all
            nodes of a yard or a street, and says nothing of which is near.
    """

    similarity: int
    heading_rad: float | None
    heading_std_rad: float
    yaw_rad: float
    length_m: float
    is_near: bool = True


def is_claim(match: NodeMatch, confidence_min: float = CONFIDENCE_MIN) -> bool:
    """Whether two-view geometry is sure of anything."""
    if match.yaw_rad is None or match.status not in ("ok", "no_baseline"):
        return False
    return _at_the_spot(match) or match.confidence >= confidence_min


def claim_of(
    graph: MapGraph, node_id: int, match: NodeMatch, confidence_min: float = CONFIDENCE_MIN
) -> Claim | None:
    """What a match claims; None where two-view geometry is not sure of anything.

    Args:
        graph: the map, which tells how far views carry.
        node_id: the node.
        match: picture against node.
        confidence_min: below it a match claims nothing.
    """
    if match.yaw_rad is None or not is_claim(match, confidence_min):
        return None
    length_m = length_to_m(graph, node_id, match.inliers)
    near = _moves_as_near(match, length_m)
    if _at_the_spot(match):
        return Claim(match.inliers, None, 0.0, match.yaw_rad, 0.0, near)
    heading_std_rad = match.heading_std_rad or 0.0
    return Claim(match.inliers, match.heading_rad, heading_std_rad, match.yaw_rad, length_m, near)


def _at_the_spot(match: NodeMatch) -> bool:
    """Whether the two are taken for one spot: there is no direction."""
    return match.status == "no_baseline" or match.heading_rad is None or match.disparity_rad is None


def _moves_as_near(match: NodeMatch, length_m: float) -> bool:
    if match.disparity_rad is None or length_m <= NEAR_M:
        return True
    return match.disparity_rad >= NEAR_RAD_PER_M * length_m
