"""What an inspection saw."""

import math
from datetime import UTC, datetime
from typing import Any, Self

from pydantic import BaseModel


class Change(BaseModel):
    """A region of the newer picture in which something was taken away, brought or moved.

    Attributes:
        bearing_deg: of its middle in the newer picture: 0 ahead, positive to the left.
        before_deg: the same direction in the earlier picture, whose camera was turned otherwise.
        elevation_deg: of its middle above the horizon.
        width_deg, height_deg: of the box round it.
    """

    bearing_deg: float
    before_deg: float
    elevation_deg: float
    width_deg: float
    height_deg: float

    @classmethod
    def of(cls, told: dict[str, Any], yaw_rad: float) -> Self:
        """From the gateway's region; `yaw_rad` is the turn from the earlier camera to the newer one."""
        bearing_rad = told["bearing_rad"]
        return cls(
            bearing_deg=_degrees(bearing_rad),
            before_deg=_degrees(math.remainder(bearing_rad + yaw_rad, math.tau)),
            elevation_deg=_degrees(told["elevation_rad"]),
            width_deg=_degrees(told["width_rad"]),
            height_deg=_degrees(told["height_rad"]),
        )


class Visit(BaseModel):
    """A place in a round.

    Attributes:
        seen: when its picture was taken.
        before: when the picture was taken that it was compared with; None where it was not.
        why: why it was not compared; words of the robot, not instructions.
        changes: the most significant first; none in a picture that was compared: nothing changed.
    """

    place: str
    seen: datetime
    before: datetime | None
    why: str
    changes: list[Change]

    @classmethod
    def of(cls, told: dict[str, Any]) -> Self:
        """From the gateway's visit."""
        before_ns = told["against_ns"]
        return cls(
            place=told["place"],
            seen=_time(told["stamp_ns"]),
            before=None if before_ns is None else _time(before_ns),
            why=told["why"],
            changes=[Change.of(each, told["yaw_rad"] or 0.0) for each in told["changes"]],
        )


class Round(BaseModel):
    """One round of an inspection, or of it the place that was asked about."""

    round: str
    visits: list[Visit]

    @classmethod
    def of(cls, told: dict[str, Any]) -> Self:
        """From the gateway's round."""
        return cls(round=told["round"], visits=[Visit.of(each) for each in told["visits"]])


def _degrees(angle_rad: float) -> float:
    return round(math.degrees(angle_rad), 1)


def _time(stamp_ns: int) -> datetime:
    return datetime.fromtimestamp(stamp_ns // 10**9, UTC)
