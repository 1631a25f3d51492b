"""Rearranging where furniture brings walls and floor: what stands in the way is told by outlines. Pure.

A box round the walls of a house holds all of the house; and there are no rooms that say where floor is.
"""

import math

import numpy as np
import numpy.typing as npt

from simulator.furniture.catalogue import FURNITURE
from simulator.generation.pieces import Placed
from simulator.generation.plans.rectangles import Rect
from simulator.scene.parts import moved
from simulator.world.brought_floor import floor_grid
from simulator.world.contents import expand
from simulator.world.footprints import Footprints, clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M
from simulator.world.world_file import WorldFile

FloatArray = npt.NDArray[np.float64]
STEP_M = 0.1  # between points at which a box is looked at; chosen: thinner than what stands on floors
BROUGHT = "mesh"  # the kind of furniture whose outline may be hollow


class BroughtPlaces:
    """Floor and outlines of a world whose furniture brings them."""

    def __init__(self, world: WorldFile) -> None:
        """Find the floor; a world with floors of its own has all it needs in its rectangles."""
        self._outlines: dict[int, tuple[Placed, Footprints]] = {}
        self._bare = any(ground.floor is None for ground in world.grounds)
        if not self._bare:
            return
        rects = world.rectangles()
        low = [min(rect[axis][0] for rect in rects) for axis in (0, 1)]
        high = [max(rect[axis][1] for rect in rects) for axis in (0, 1)]
        self._low = np.array(low)
        xs, ys = (np.arange(a, b + STEP_M / 2, STEP_M) for a, b in zip(low, high, strict=True))
        self._floor = floor_grid(world, expand(world)[0], xs, ys)

    def holds(self, box: Rect) -> bool:
        """Whether there is floor below all of a box."""
        if not self._bare:
            return True
        column, row = np.round((_points(box) - self._low) / STEP_M).astype(int).T
        rows, columns = self._floor.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        return bool(inside.all() and self._floor[row, column].all())

    def apart(self, box: Rect, other: Placed, gap_m: float) -> bool:
        """Whether a box keeps a gap to a piece."""
        if box.gap_m(other.box) >= gap_m:
            return True
        if other.kind != BROUGHT:
            return False
        return float(clearance_m(_points(box), self._outline(other)).min()) >= gap_m

    def straight_way(self, a: Rect, b: Rect, others: list[Placed]) -> bool:
        """Whether no hollow piece, as walls are, lies between the middles of two boxes."""
        start, end = np.array(a.centre_m), np.array(b.centre_m)
        count = max(2, math.ceil(float(np.hypot(*(end - start))) / (STEP_M / 2)))
        way = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
        walls = (other for other in others if other.kind == BROUGHT and other.box.holds(a))
        return all(float(clearance_m(way, self._outline(wall)).min()) > 0.0 for wall in walls)

    def _outline(self, piece: Placed) -> Footprints:
        kept = self._outlines.get(id(piece))
        if kept is None or kept[0] is not piece:
            built = FURNITURE[piece.kind].build(piece.options, piece.seed)
            there = moved(built, *piece.at_m, math.radians(piece.yaw_deg), piece.z_m)
            kept = piece, footprints(there.parts, *BODY_BAND_M)
            self._outlines[id(piece)] = kept
        return kept[1]


def _points(box: Rect) -> FloatArray:
    """Points of a box no further apart than STEP_M, its edges included, (n, 2)."""
    xs = np.linspace(box.x0, box.x1, max(2, math.ceil((box.x1 - box.x0) / STEP_M) + 1))
    ys = np.linspace(box.y0, box.y1, max(2, math.ceil((box.y1 - box.y0) / STEP_M) + 1))
    return np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
