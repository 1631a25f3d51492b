"""What a plan consists of: rectangles of floor with a use each, and doorways between them. Pure."""

from dataclasses import dataclass

Point = tuple[float, float]

WALL_M = 0.15
"""Between two rooms: both their walls, as in the worlds drawn by hand."""
TOUCH_M = 1e-6
"""Rounding."""


@dataclass(frozen=True)
class Rect:
    """An axis-parallel rectangle, metres."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def size_m(self) -> Point:
        """Along x and along y."""
        return self.x1 - self.x0, self.y1 - self.y0

    @property
    def centre_m(self) -> Point:
        """Its middle."""
        return (self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2

    @property
    def area_m2(self) -> float:
        """Of its floor."""
        return self.size_m[0] * self.size_m[1]

    def grown(self, x_m: float, y_m: float | None = None) -> "Rect":
        """Wider by so much on every side; narrower if negative."""
        y_m = x_m if y_m is None else y_m
        return Rect(self.x0 - x_m, self.y0 - y_m, self.x1 + x_m, self.y1 + y_m)

    def moved(self, x_m: float, y_m: float) -> "Rect":
        """Elsewhere."""
        return Rect(self.x0 + x_m, self.y0 + y_m, self.x1 + x_m, self.y1 + y_m)

    def with_other(self, other: "Rect") -> "Rect":
        """The least one round both."""
        low = min(self.x0, other.x0), min(self.y0, other.y0)
        return Rect(*low, max(self.x1, other.x1), max(self.y1, other.y1))

    def holds(self, other: "Rect") -> bool:
        """Whether another one lies inside."""
        low = self.x0 <= other.x0 + TOUCH_M and self.y0 <= other.y0 + TOUCH_M
        return low and other.x1 <= self.x1 + TOUCH_M and other.y1 <= self.y1 + TOUCH_M

    def nearest(self, point: Point) -> Point:
        """Of its points the one nearest to another."""
        return min(max(point[0], self.x0), self.x1), min(max(point[1], self.y0), self.y1)

    def gap_m(self, other: "Rect") -> float:
        """Distance to another one; 0 where they touch, below where they overlap."""
        x_m = max(self.x0 - other.x1, other.x0 - self.x1)
        y_m = max(self.y0 - other.y1, other.y0 - self.y1)
        return float((x_m**2 + y_m**2) ** 0.5) if x_m > 0.0 and y_m > 0.0 else max(x_m, y_m)


@dataclass(frozen=True)
class RoomPlan:
    """A piece of floor.

    Attributes:
        name: its own.
        use: what it is used for, a key of `furnishing.USES`.
        rect: the floor.
        border: of ground under the open sky, what runs along its edges; "" for a room.
    """

    name: str
    use: str
    rect: Rect
    border: str = ""


@dataclass(frozen=True)
class Plan:
    """Rooms, and the doorways that lie in the walls between them.

    Attributes:
        start: where the robot starts.
        alike: the rooms of each of these uses are furnished alike, but for small things.
    """

    rooms: tuple[RoomPlan, ...]
    doors: tuple[Rect, ...]
    start: Point
    alike: frozenset[str] = frozenset()


def ways_through(door: Rect, ahead_m: float) -> Rect:
    """The floor that has to stay free before and behind a doorway."""
    along_x = door.size_m[0] > door.size_m[1]
    return door.grown(0.05, ahead_m) if along_x else door.grown(ahead_m, 0.05)
