"""What two peers cover over driven metres: nearest frontier on a metric grid, and a random walk. Pure.

Both know their pose exactly, and cover floor as a map of pictures does: within a radius of where they were.
"""

import heapq
import math
from dataclasses import dataclass, field
from typing import Self

import numpy as np
import numpy.typing as npt

from services.launcher.evaluation.coverage_curve import Curve
from simulator.world.freespace import FreeSpace, Point

CELL_M = 0.1
RAYS = 240
"""Of the scanner; chosen: 1.5 degrees, neighbours 0.1 m apart at 4 m."""
AGAIN_M = 0.5
"""Driven before it plans again; chosen: half of what it covers indoors."""
WALK_STEP_M = 0.1
WALK_MAX_M = 20_000.0
"""A random walk is given up here: a hundred times what exploring takes."""

Cell = tuple[int, int]
Grid = npt.NDArray[np.bool_]
KING = tuple((dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx)


def frontier_curve(space: FreeSpace, start: Point, covered_m: float, sight_m: float, share: float) -> Curve:
    """What a robot with a perfect scanner and perfect poses has covered, by driven metres.

    It drives to the nearest floor that it has seen and not covered, else to the nearest frontier between seen
    and unseen floor (Yamauchi 1997), and plans again every AGAIN_M.

    Args:
        space: the free floor.
        start: where it begins, metres.
        covered_m: radius that it covers, metres.
        sight_m: range of its scanner, metres.
        share: of the floor, 0 to 1, at which it ends; earlier where the floor cannot be covered that far.
    """
    floor = _Floor.of(space, start)
    seen = np.zeros_like(floor.free)
    driven_m = 0.0
    curve: Curve = []
    while True:
        floor.cover(covered_m)
        curve.append((driven_m, floor.covered_share))
        if floor.covered_share >= share:
            return curve
        seen |= _visible(floor, sight_m)
        way = _way_to_nearest(floor, floor.free & seen & ~floor.covered, seen)
        way = way or _way_to_nearest(floor, _frontier(floor.free, seen), seen)
        if not way:
            return curve
        for cell in way[: max(1, round(AGAIN_M / floor.cell_m))]:
            driven_m += math.dist(floor.at, cell) * floor.cell_m
            floor.at = cell
            floor.cover(covered_m)


def walk_curve(space: FreeSpace, start: Point, covered_m: float, share: float, seed: int) -> Curve:
    """What a random walk covers: straight on, and in a direction drawn anew at every obstacle.

    Args:
        space: the free floor.
        start: where it begins, metres.
        covered_m: radius that it covers, metres.
        share: of the floor, 0 to 1, at which it ends; or after WALK_MAX_M.
        seed: draws directions.
    """
    rng, floor = np.random.default_rng(seed), _Floor.of(space, start)
    x, y, heading_rad, driven_m = *start, float(rng.uniform(-math.pi, math.pi)), 0.0
    curve: Curve = []
    while driven_m < WALK_MAX_M:
        floor.cover(covered_m)
        if not curve or floor.covered_share > curve[-1][1]:
            curve.append((driven_m, floor.covered_share))
        if floor.covered_share >= share:
            break
        there = x + WALK_STEP_M * math.cos(heading_rad), y + WALK_STEP_M * math.sin(heading_rad)
        if space.is_free(there):
            x, y = there
            driven_m += WALK_STEP_M
            floor.at = floor.cell_of(there)
        else:
            heading_rad = float(rng.uniform(-math.pi, math.pi))
    return curve


@dataclass
class _Floor:
    """Free floor in cells, where the robot is, and what it has covered."""

    free: Grid
    open_: Grid
    origin_m: Point
    cell_m: float
    at: Cell
    covered: Grid = field(init=False)

    def __post_init__(self) -> None:
        self.covered = np.zeros_like(self.free)

    @classmethod
    def of(cls, space: FreeSpace, start: Point) -> Self:
        every = max(1, round(CELL_M / space.resolution_m))
        free = space.free[::every, ::every]
        open_ = (space.clearance_m > space.resolution_m)[::every, ::every]
        floor = cls(free, open_, space.origin_m, every * space.resolution_m, (0, 0))
        rows, columns = np.nonzero(free)
        row, column = floor.cell_of(start)
        nearest = int(np.argmin((rows - row) ** 2 + (columns - column) ** 2))
        floor.at = int(rows[nearest]), int(columns[nearest])
        return floor

    @property
    def covered_share(self) -> float:
        return float((self.covered & self.free).sum() / self.free.sum())

    def cell_of(self, point: Point) -> Cell:
        x, y = point
        return round((y - self.origin_m[1]) / self.cell_m), round((x - self.origin_m[0]) / self.cell_m)

    def cover(self, radius_m: float) -> None:
        reach = int(radius_m / self.cell_m)
        row, column = self.at
        rows = np.arange(max(0, row - reach), min(self.free.shape[0], row + reach + 1))
        columns = np.arange(max(0, column - reach), min(self.free.shape[1], column + reach + 1))
        near = np.hypot(rows[:, None] - row, columns[None, :] - column) * self.cell_m <= radius_m
        self.covered[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] |= near


def _visible(floor: _Floor, sight_m: float) -> Grid:
    """Floor that a scanner at the robot sees."""
    angles = np.linspace(0.0, math.tau, RAYS, endpoint=False)
    along = np.arange(0.0, sight_m / floor.cell_m, 0.5)
    rows = np.rint(floor.at[0] + np.sin(angles)[:, None] * along).astype(int)
    columns = np.rint(floor.at[1] + np.cos(angles)[:, None] * along).astype(int)
    inside = (rows >= 0) & (rows < floor.free.shape[0]) & (columns >= 0) & (columns < floor.free.shape[1])
    rows, columns = np.where(inside, rows, 0), np.where(inside, columns, 0)
    clear = np.logical_and.accumulate(inside & floor.open_[rows, columns], axis=1)
    clear[:, 0] = True
    seen = np.zeros_like(floor.free)
    seen[rows[clear], columns[clear]] = True
    return seen


def _frontier(free: Grid, seen: Grid) -> Grid:
    """Seen free floor beside unseen free floor."""
    unseen, beside = np.pad(free & ~seen, 1), np.zeros_like(free)
    for dy, dx in KING:
        beside |= unseen[1 + dy : 1 + dy + free.shape[0], 1 + dx : 1 + dx + free.shape[1]]
    return free & seen & beside


def _way_to_nearest(floor: _Floor, wanted: Grid, known: Grid) -> list[Cell]:
    """Cells of the shortest way over known floor to the nearest wanted cell, without the robot's own."""
    queue: list[tuple[float, Cell]] = [(0.0, floor.at)]
    cost, came = {floor.at: 0.0}, {floor.at: floor.at}
    while queue:
        so_far, cell = heapq.heappop(queue)
        if so_far > cost[cell]:
            continue
        if wanted[cell] and cell != floor.at:
            return _back(came, cell)
        for dy, dx in KING:
            beside = cell[0] + dy, cell[1] + dx
            inside = 0 <= beside[0] < floor.free.shape[0] and 0 <= beside[1] < floor.free.shape[1]
            if not inside or not (floor.free[beside] and known[beside]):
                continue
            through = so_far + math.hypot(dy, dx)
            if through < cost.get(beside, math.inf):
                cost[beside], came[beside] = through, cell
                heapq.heappush(queue, (through, beside))
    return []


def _back(came: dict[Cell, Cell], cell: Cell) -> list[Cell]:
    way = [cell]
    while came[way[-1]] != way[-1]:
        way.append(came[way[-1]])
    return way[-2::-1]
