"""Whether three views can be where they say they are: yaws and bearings round a triangle. Pure.

Angles are radians, counter-clockwise, 0 ahead, each in the camera frame of the view it is measured from.
"""

import math
from typing import NamedTuple

YAW_RAD = math.radians(8.0)
"""Yaws round a triangle may miss a full circle by this much. True ones miss by 1.1 degrees at most (490
triangles of the apartment's map, `topnav study cycles`); aliased views by any angle."""

DIRECTION_RAD = math.radians(15.0)
"""Bearings round a triangle may miss closing by this much; in the same 490 triangles 1.4 degrees at most."""


class Sight(NamedTuple):
    """One view as seen from another.

    Attributes:
        heading_rad: bearing of it, camera frame of the view it is seen from; None where both stand at one
            spot or nobody knows.
        yaw_rad: rotation from the camera it is seen from to its own; None when unknown.
    """

    heading_rad: float | None
    yaw_rad: float | None


class Misses(NamedTuple):
    """By how much a triangle does not close.

    Attributes:
        yaw_rad: of the yaws round it.
        direction_rad: of the bearings; None where one is unknown: then one of the three is where the frame
            is, and there is no triangle.
    """

    yaw_rad: float
    direction_rad: float | None


def triangle_closes(to_node: Sight, to_neighbour: Sight, onward: Sight) -> bool:
    """Whether the yaws add up round frame, node and neighbour, and the bearings between them can close.

    Args:
        to_node: the node seen from the frame.
        to_neighbour: the neighbour seen from the frame.
        onward: the neighbour seen from the node.

    Returns:
        False also when a yaw is unknown; where a bearing is unknown only the yaws count.
    """
    misses = triangle_misses(to_node, to_neighbour, onward)
    if misses is None or misses.yaw_rad > YAW_RAD:
        return False
    return misses.direction_rad is None or misses.direction_rad < DIRECTION_RAD


def triangle_misses(to_node: Sight, to_neighbour: Sight, onward: Sight) -> Misses | None:
    """What the three views of `triangle_closes` miss; None when a yaw is unknown.

    Seen from the frame, the bearing node -> neighbour must lie between the bearing of the neighbour and the
    opposite of the bearing of the node.
    """
    if onward.yaw_rad is None or to_node.yaw_rad is None or to_neighbour.yaw_rad is None:
        return None
    yaw_rad = apart_rad(to_node.yaw_rad + onward.yaw_rad, to_neighbour.yaw_rad)
    if to_node.heading_rad is None or to_neighbour.heading_rad is None or onward.heading_rad is None:
        return Misses(yaw_rad, None)
    onward_rad = onward.heading_rad + to_node.yaw_rad
    back_rad = to_node.heading_rad + math.pi
    detour_rad = apart_rad(to_neighbour.heading_rad, onward_rad) + apart_rad(onward_rad, back_rad)
    return Misses(yaw_rad, detour_rad - apart_rad(to_neighbour.heading_rad, back_rad))


def apart_rad(first_rad: float, second_rad: float) -> float:
    """Angle between two directions, 0 to pi."""
    return abs(math.remainder(first_rad - second_rad, math.tau))
