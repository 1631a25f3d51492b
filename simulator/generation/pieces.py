"""Walls of a room, and furniture where it stands. Pure."""

from dataclasses import dataclass, replace
from typing import Any

from simulator.generation.extents import extent, placed_box
from simulator.generation.plans.rectangles import Point, Rect

YAWS = (0.0, 90.0, 180.0, -90.0)
"""Of what stands at a west, south, east and north wall, degrees: it faces into the room."""


@dataclass(frozen=True)
class Wall:
    """A side of a room: where it lies, which way its furniture faces, whether there is daylight behind it."""

    yaw_deg: float
    low: Point
    high: Point
    outside: bool

    @property
    def length_m(self) -> float:
        """From one corner to the other."""
        return abs(self.high[0] - self.low[0]) + abs(self.high[1] - self.low[1])

    def point(self, along_m: float) -> Point:
        """On the wall, so far from its low end."""
        share = along_m / self.length_m
        x, y = (low + share * (high - low) for low, high in zip(self.low, self.high, strict=True))
        return round(x, 3), round(y, 3)


@dataclass(frozen=True)
class Placed:
    """A piece of furniture where it stands, as a world file has it.

    Attributes:
        box: the floor that belongs to it.
        solid: whether the robot can run into it.
    """

    kind: str
    at_m: Point
    yaw_deg: float
    z_m: float
    seed: int
    options: dict[str, Any]
    box: Rect
    solid: bool

    def longer(self, front_m: float) -> "Placed":
        """With so much more floor before its front; for yaws of right angles."""
        b, k = self.box, round(self.yaw_deg / 90.0) % 4
        grown = (
            Rect(b.x0, b.y0, b.x1 + front_m, b.y1),
            Rect(b.x0, b.y0, b.x1, b.y1 + front_m),
            Rect(b.x0 - front_m, b.y0, b.x1, b.y1),
            Rect(b.x0, b.y0 - front_m, b.x1, b.y1),
        )[k]
        return replace(self, box=grown)


def piece_at(
    kind: str, at_m: Point, yaw_deg: float, seed: int, options: dict[str, Any] | None, z_m: float = 0.0
) -> Placed:
    """A piece with the floor that it covers."""
    size = extent(kind, options or {}, seed)
    box = placed_box(size.box, at_m, yaw_deg)
    return Placed(kind, at_m, yaw_deg, z_m, seed, options or {}, box, size.solid)


def walls_of(rect: Rect, outside: frozenset[float]) -> list[Wall]:
    """The four of a room.

    Args:
        rect: its floor.
        outside: yaws of those with daylight behind them.
    """
    r = rect
    ends = (
        ((r.x0, r.y0), (r.x0, r.y1)),
        ((r.x0, r.y0), (r.x1, r.y0)),
        ((r.x1, r.y0), (r.x1, r.y1)),
        ((r.x0, r.y1), (r.x1, r.y1)),
    )
    return [Wall(yaw, low, high, yaw in outside) for yaw, (low, high) in zip(YAWS, ends, strict=True)]
