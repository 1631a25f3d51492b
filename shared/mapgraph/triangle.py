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


def triangle_closes(to_node: Sight, to_neighbour: Sight, onward: Sight) -> bool:
    """Whether the yaws add up round frame, node and neighbour, and the bearings between them can close.

    Seen from the frame, the bearing node -> neighbour must lie between the bearing of the neighbour and the
    opposite of the bearing of the node.

    Args:
        to_node: the node seen from the frame.
        to_neighbour: the neighbour seen from the frame.
        onward: the neighbour seen from the node.

    Returns:
        False also when a yaw is unknown; where a bearing is unknown only the yaws count.
    """
    if onward.yaw_rad is None or to_node.yaw_rad is None or to_neighbour.yaw_rad is None:
        return False
    if apart_rad(to_node.yaw_rad + onward.yaw_rad, to_neighbour.yaw_rad) > YAW_RAD:
        return False
    if to_node.heading_rad is None or to_neighbour.heading_rad is None or onward.heading_rad is None:
        return True  # one of them is where the frame is: there is no triangle
    onward_rad = onward.heading_rad + to_node.yaw_rad
    back_rad = to_node.heading_rad + math.pi
    detour = apart_rad(to_neighbour.heading_rad, onward_rad) + apart_rad(onward_rad, back_rad)
    return detour - apart_rad(to_neighbour.heading_rad, back_rad) < DIRECTION_RAD


def apart_rad(first_rad: float, second_rad: float) -> float:
    """Angle between two directions, 0 to pi."""
    return abs(math.remainder(first_rad - second_rad, math.tau))
