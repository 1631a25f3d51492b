"""Furniture that people move, take away or exchange. Pure."""

import math
from dataclasses import replace

import numpy as np

from simulator.generation.brought import BROUGHT, BroughtPlaces
from simulator.generation.extents import extent
from simulator.generation.pieces import Placed, piece_at
from simulator.generation.plans.rectangles import Rect
from simulator.world.world_file import WorldFile

MOST_M2 = 3.0
"""Footprint of what two people carry; chosen."""
MOST_HIGH_M = 2.3
"""Higher things are built in, or houses."""
FAR_M = 1.5
"""How far a piece is moved at most, along each axis; chosen: within its room."""
TURNS_DEG = (0.0, 0.0, 90.0, 180.0, -90.0)
TRIES = 30
BESIDE_M = 0.02
TOUCH_M = 0.01
START_FREE_M = 0.5
ON_FLOOR_M = 0.05
"""What begins lower stands on the floor; chosen: models float or sink a little."""


class Rearranging:
    """Pieces of a world while they are changed.

    Attributes:
        pieces: in the order of the world's furniture; None where one was taken away.
        sources: of each piece, the number of the item whose looks it has.
        movable: those that stand on the floor and that people can carry.
    """

    def __init__(self, world: WorldFile, own: int, rng: np.random.Generator) -> None:
        """Take the furniture of a world, of which the first `own` pieces may be changed."""
        self.pieces: list[Placed | None] = [
            piece_at(item.kind, item.at_m, item.yaw_deg, item.seed, item.options, item.z_m)
            for item in world.furniture
        ]
        self.sources = list(range(len(self.pieces)))
        self._own, self._rng, self._places = own, rng, BroughtPlaces(world)
        self._floors = [Rect(x[0], y[0], x[1], y[1]) for x, y in world.rectangles()]
        self._start = Rect(world.start.x_m, world.start.y_m, world.start.x_m, world.start.y_m)
        stock = [(k, piece) for k, piece in enumerate(self.pieces[:own]) if piece and _is_movable(piece)]
        self.movable = [k for k, _ in stock]
        self._stock = stock

    def remove(self, k: int) -> None:
        """Take it away, with what stands on it."""
        for j in (k, *self._on_top(k)):
            self.pieces[j] = None

    def move(self, k: int) -> None:
        """Elsewhere in its room, turned; it stays where it is if there is no room."""
        piece = self.pieces[k]
        if piece is None:
            return
        for _ in range(TRIES):
            x, y = (piece.at_m + self._rng.uniform(-FAR_M, FAR_M, 2)).round(2).tolist()
            turn_deg = float(TURNS_DEG[int(self._rng.integers(len(TURNS_DEG)))])
            there = _turned(piece, (x, y), turn_deg)
            if self._fits(k, there) and self._in_the_room(k, piece, there):
                for j in self._on_top(k):
                    self.pieces[j] = _carried(self.pieces[j], piece, there, turn_deg)
                self.pieces[k] = there
                return

    def exchange(self, k: int) -> None:
        """For another piece of the same world that takes no more floor; for nothing if there is none."""
        piece = self.pieces[k]
        if piece is None:
            return
        self.remove(k)
        for _ in range(TRIES):
            source, other = self._stock[int(self._rng.integers(len(self._stock)))]
            turn_deg = piece.yaw_deg - other.yaw_deg
            (x0, y0), (x1, y1) = _turned(other, (0.0, 0.0), turn_deg).box.centre_m, piece.box.centre_m
            there = _turned(other, (round(x1 - x0, 3), round(y1 - y0, 3)), turn_deg)
            differs = (other.kind, other.options) != (piece.kind, piece.options)
            if (differs if other.kind == BROUGHT else other.kind != piece.kind) and self._fits(k, there):
                self.pieces[k], self.sources[k] = there, source
                return

    def _fits(self, k: int, there: Placed) -> bool:
        box = there.box
        inside = any(floor.grown(TOUCH_M).holds(box) for floor in self._floors)
        if not inside or box.gap_m(self._start) < START_FREE_M or not self._places.holds(box):
            return False
        away = {k, *self._on_top(k)}
        others = (other for j, other in enumerate(self.pieces) if other and other.solid and j not in away)
        return all(self._places.apart(box, other, BESIDE_M) for other in others)

    def _in_the_room(self, k: int, piece: Placed, there: Placed) -> bool:
        others = [other for j, other in enumerate(self.pieces) if other and other.solid and j != k]
        return self._places.straight_way(piece.box, there.box, others)

    def _on_top(self, k: int) -> list[int]:
        """What stands on a piece."""
        piece = self.pieces[k]
        if piece is None:
            return []
        pieces = enumerate(self.pieces[: self._own])
        above = ((j, other) for j, other in pieces if other and _low_m(other) > ON_FLOOR_M)
        over = [(j, other) for j, other in above if piece.box.holds(Rect(*other.at_m, *other.at_m))]
        if piece.kind != BROUGHT:
            return [j for j, _ in over]
        top_m, found = _high_m(piece), []  # lamps that hang over it stay
        for j, other in sorted(over, key=lambda one: _low_m(one[1])):
            if other.kind == BROUGHT and _low_m(other) <= top_m + ON_FLOOR_M:
                top_m = max(top_m, _high_m(other))
                found.append(j)
        return found


def _is_movable(piece: Placed) -> bool:
    if abs(_low_m(piece)) > ON_FLOOR_M or not piece.solid or "door" in piece.kind:
        return False
    high_m = extent(piece.kind, piece.options, piece.seed).high_m
    return piece.box.area_m2 <= MOST_M2 and high_m <= MOST_HIGH_M


def _low_m(piece: Placed) -> float:
    """Height of its lowest point; of what is not brought by a model, of its anchor."""
    low_m = extent(piece.kind, piece.options, piece.seed).low_m if piece.kind == BROUGHT else 0.0
    return piece.z_m + low_m


def _high_m(piece: Placed) -> float:
    return piece.z_m + extent(piece.kind, piece.options, piece.seed).high_m


def _turned(piece: Placed, at_m: tuple[float, float], turn_deg: float) -> Placed:
    yaw_deg = math.remainder(piece.yaw_deg + turn_deg, 360.0)
    return piece_at(piece.kind, at_m, yaw_deg, piece.seed, piece.options, piece.z_m)


def _carried(top: Placed | None, before: Placed, after: Placed, turn_deg: float) -> Placed | None:
    """What stood on a piece, now that the piece stands elsewhere."""
    if top is None:
        return None
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    dx, dy = top.at_m[0] - before.at_m[0], top.at_m[1] - before.at_m[1]
    at_m = round(after.at_m[0] + c * dx - s * dy, 3), round(after.at_m[1] + s * dx + c * dy, 3)
    return replace(_turned(top, at_m, turn_deg), z_m=top.z_m)
