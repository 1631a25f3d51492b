"""Where furniture fits in a room: against walls, on walls, in the open; ways stay wide enough. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from simulator.generation.extents import extent
from simulator.generation.pieces import YAWS, Placed, Wall, piece_at, walls_of
from simulator.generation.plans.rectangles import Point, Rect

NICHE_M = 0.45
"""A gap this narrow is none: the robot is 0.5 m wide, and does not see a way there."""
WAY_M = 0.95
"""A gap this wide is a way: 0.2 m to spare on either side."""
TRIES = 40
"""Spots drawn for a piece before it is left out; chosen."""
BESIDE_M = 0.02
"""Between two pieces side by side."""
SEEDS = 8
"""Looks of a kind of furniture: the renderer shows 480 different ones in a world."""
ROW_SEED = 1
"""Things in rows look alike."""

Options = dict[str, Any] | None


@dataclass
class Furnisher:
    """Furnishes one room.

    Attributes:
        rect: its floor.
        keep_free: floor that stays free: ways through doors, where the robot starts.
        gaps: doors and rooms beside it: nothing hangs there.
        outside: yaws of the walls with daylight behind them.
        rng: draws spots and looks.
        placed: what stands there, in the order it came.
    """

    rect: Rect
    keep_free: Sequence[Rect]
    gaps: Sequence[Rect]
    outside: frozenset[float]
    rng: np.random.Generator
    placed: list[Placed] = field(default_factory=list)

    def against_wall(
        self, kind: str, options: Options = None, *, front_m: float = 0.0, centred: bool = False
    ) -> Placed | None:
        """Stand a piece with its back to a wall; None where there is no room for it.

        Args:
            kind: of furniture; its front is along +x.
            options: of its kind.
            front_m: more floor that belongs to it, before its front: for a chair.
            centred: its origin is its middle, not its back.
        """
        seed = self._seed()
        box = extent(kind, options or {}, seed).box
        back_m = -box.x0 if centred else 0.0
        for _ in range(TRIES):
            wall = self._any_wall()
            low, high = -box.y0, wall.length_m - box.y1
            if high <= low:
                continue
            x, y = wall.point(float(self.rng.uniform(low, high)))
            c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[YAWS.index(wall.yaw_deg)]
            at_m = round(x + c * back_m, 3), round(y + s * back_m, 3)
            piece = piece_at(kind, at_m, wall.yaw_deg, seed, options).longer(front_m)
            if self._fits(piece):
                return self._add(piece)
        return None

    def in_the_open(
        self, kind: str, options: Options = None, *, yaws: Sequence[float] = YAWS, around_m: float = 0.0
    ) -> Placed | None:
        """Stand a piece where one can go all the way round it; None where there is no room for it.

        Args:
            kind: of furniture.
            options: of its kind.
            yaws: of which one is drawn, degrees.
            around_m: more floor that belongs to it on every side: for chairs.
        """
        seed = self._seed()
        for _ in range(TRIES):
            x, y = self.rng.uniform((self.rect.x0, self.rect.y0), (self.rect.x1, self.rect.y1)).tolist()
            yaw_deg = float(yaws[int(self.rng.integers(len(yaws)))])
            piece = piece_at(kind, (round(x, 2), round(y, 2)), yaw_deg, seed, options)
            piece = replace(piece, box=piece.box.grown(around_m))
            if self._fits(piece, free=True):
                return self._add(piece)
        return None

    def stand(
        self,
        kind: str,
        at_m: Point,
        yaw_deg: float,
        options: Options = None,
        *,
        front_m: float = 0.0,
        both: bool = False,
    ) -> bool:
        """Stand a piece of a row at its spot, if ways round it stay free.

        Args:
            kind: of furniture.
            at_m: its origin.
            yaw_deg: of its front, a right angle.
            options: of its kind.
            front_m: more floor that belongs to it, before its front.
            both: the floor behind its back belongs to it as well: another one will stand there.
        """
        piece = piece_at(kind, at_m, yaw_deg, ROW_SEED, options).longer(front_m)
        if both:
            behind = piece_at(kind, at_m, yaw_deg + 180.0, ROW_SEED, options).longer(front_m)
            piece = replace(piece, box=piece.box.with_other(behind.box))
        fits = self._fits(piece, free=True)
        if fits:
            self._add(piece)
        return fits

    def at(
        self,
        kind: str,
        at_m: Point,
        yaw_deg: float,
        options: Options = None,
        *,
        seed: int | None = None,
        z_m: float = 0.0,
    ) -> Placed:
        """Stand a piece just there: on or at another one."""
        at_m = round(at_m[0], 3), round(at_m[1], 3)
        return self._add(piece_at(kind, at_m, yaw_deg, self._seed() if seed is None else seed, options, z_m))

    def on_wall(
        self, kind: str, z_m: float, options: Options = None, *, daylight: bool = False
    ) -> Placed | None:
        """Hang a piece where nothing tall stands and no door is; with `daylight` on an outer wall only."""
        seed = self._seed()
        size = extent(kind, options or {}, seed)
        for _ in range(TRIES):
            wall = self._any_wall()
            low, high = 0.1 - size.box.y0, wall.length_m - 0.1 - size.box.y1
            if high <= low or (daylight and not wall.outside):
                continue
            at_m = wall.point(float(self.rng.uniform(low, high)))
            piece = piece_at(kind, at_m, wall.yaw_deg, seed, options, z_m)
            if not self._is_covered(piece, z_m + size.low_m, z_m + size.high_m):
                return self._add(piece)
        return None

    def _is_covered(self, piece: Placed, low_m: float, high_m: float) -> bool:
        """Whether a door or another piece is where a piece would hang."""
        if any(piece.box.grown(0.1).gap_m(gap) <= 0.0 for gap in self.gaps):
            return True
        for other in self.placed:
            size = extent(other.kind, other.options, other.seed)
            apart = other.z_m + size.high_m <= low_m or other.z_m + size.low_m >= high_m
            if not apart and piece.box.grown(0.03).gap_m(other.box) < 0.0:
                return True
        return False

    def _fits(self, piece: Placed, *, free: bool = False) -> bool:
        """Whether it stands inside, keeps ways free, and leaves gaps that are wide or none at all.

        Args:
            piece: where it would stand.
            free: all its gaps must be wide.
        """
        r, b = self.rect, piece.box
        if not r.grown(0.05).holds(b) or any(b.gap_m(free_floor) < 0.0 for free_floor in self.keep_free):
            return False
        beside = [b.gap_m(other.box) for other in self.placed if other.solid]
        if any(gap < BESIDE_M for gap in beside):
            return False
        least_m = -1.0 if free else NICHE_M
        to_walls = (b.x0 - r.x0, r.x1 - b.x1, b.y0 - r.y0, r.y1 - b.y1)
        return not any(least_m < gap < WAY_M for gap in (*beside, *to_walls))

    def _add(self, piece: Placed) -> Placed:
        self.placed.append(piece)
        return piece

    def _seed(self) -> int:
        return int(self.rng.integers(SEEDS))

    def _any_wall(self) -> Wall:
        walls = walls_of(self.rect, self.outside)
        lengths = np.array([wall.length_m for wall in walls])
        return walls[int(self.rng.choice(len(walls), p=lengths / lengths.sum()))]
