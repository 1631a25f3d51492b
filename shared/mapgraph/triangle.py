"""Whether three views can be where they say they are: turns and directions round a triangle. Pure.

Angles are radians, counter-clockwise, 0 ahead, each in the camera frame of the view it is measured from.
"""

import math
from typing import NamedTuple

YAW_RAD = math.radians(8.0)
"""Turns round a triangle may miss a full circle by this much."""

DIRECTION_RAD = math.radians(15.0)
"""Directions round a triangle may miss closing by this much."""


class Sight(NamedTuple):
    """One view as seen from another.

    Attributes:
        heading_rad: direction to it, camera frame of the view it is seen from; None where both are one place
            or nobody knows.
        yaw_rad: rotation from the camera it is seen from to its own; None when unknown.
    """

    heading_rad: float | None
    yaw_rad: float | None


def triangle_closes(to_place: Sight, to_witness: Sight, onward: Sight) -> bool:
    """Whether the turns add up round frame, place and witness, and the directions between them can close.

    Seen from the frame, the direction place -> witness must lie between the direction to the witness and the
    opposite of the direction to the place.

    Args:
        to_place: the place seen from the frame.
        to_witness: the witness seen from the frame.
        onward: the witness seen from the place.

    Returns:
        False also when a turn is unknown; where a direction is unknown only the turns count.
    """
    if onward.yaw_rad is None or to_place.yaw_rad is None or to_witness.yaw_rad is None:
        return False
    if apart_rad(to_place.yaw_rad + onward.yaw_rad, to_witness.yaw_rad) > YAW_RAD:
        return False
    if to_place.heading_rad is None or to_witness.heading_rad is None or onward.heading_rad is None:
        return True  # one of them is where the frame is: there is no triangle
    onward_rad = onward.heading_rad + to_place.yaw_rad
    back_rad = to_place.heading_rad + math.pi
    detour = apart_rad(to_witness.heading_rad, onward_rad) + apart_rad(onward_rad, back_rad)
    return detour - apart_rad(to_witness.heading_rad, back_rad) < DIRECTION_RAD


def apart_rad(first_rad: float, second_rad: float) -> float:
    """Angle between two directions, 0 to pi."""
    return abs(math.remainder(first_rad - second_rad, math.tau))
