"""Free floor of a world: where a robot fits, shortest ways, lines of sight, random poses. Pure."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import cv2
import numpy as np
import numpy.typing as npt

from simulator.scene.parts import Part, rotation_of
from simulator.world.brought_floor import floor_grid
from simulator.world.contents import expand
from simulator.world.footprints import clearance_grid_m, footprints
from simulator.world.grid_search import shortest_cells
from simulator.world.world_file import WorldFile

FloatArray = npt.NDArray[np.float64]
Point = tuple[float, float]
BODY_BAND_M = (0.02, 0.79)  # heights in which the robot hits things: above thresholds, below the camera
FINE_M, COARSE_M = 0.05, 0.1  # cells; chosen: a fifth of the robot's radius, and twice that beyond
SMALL_WORLD_M = 30.0  # this size; larger worlds would take minutes
CAMERA_M = 0.8  # height of the camera, as in settings.CameraSettings
LOOKED_OVER_M = 0.3  # what ends so far above the camera hides a strip of the walls behind it only; chosen
FAR_M = 3.0  # clearances beyond this are of no interest and not computed; chosen


@dataclass(frozen=True)
class FreeSpace:
    """Grid of the floor that the robot's centre can reach from the world's start.

    Attributes:
        free: (rows, columns) of bool; row along y, column along x.
        clearance_m: (rows, columns) distance to the nearest obstacle outline, at most FAR_M metres.
        origin_m: centre of cell (0, 0), world frame.
        resolution_m: side of a cell.
    """

    free: npt.NDArray[np.bool_]
    clearance_m: FloatArray
    origin_m: Point
    resolution_m: float
    robot_radius_m: float
    parts: tuple[Part, ...]

    def cell(self, point: Point) -> tuple[int, int]:
        """(row, column) of the cell that holds a point; may lie outside the grid."""
        return (
            round((point[1] - self.origin_m[1]) / self.resolution_m),
            round((point[0] - self.origin_m[0]) / self.resolution_m),
        )

    def point(self, cell: tuple[int, int]) -> Point:
        """Centre of a cell."""
        return self.origin_m[0] + cell[1] * self.resolution_m, self.origin_m[1] + cell[0] * self.resolution_m

    def is_free(self, point: Point) -> bool:
        """Whether the robot's centre can be there."""
        row, column = self.cell(point)
        inside = 0 <= row < self.free.shape[0] and 0 <= column < self.free.shape[1]
        return inside and bool(self.free[row, column])

    def centres_m(self) -> FloatArray:
        """Centres of all free cells, (n, 2) metres."""
        rows, columns = np.nonzero(self.free)
        return np.stack(
            [self.origin_m[0] + columns * self.resolution_m, self.origin_m[1] + rows * self.resolution_m],
            axis=-1,
        )

    def random_pose(self, rng: np.random.Generator, margin_m: float = 0.0) -> tuple[float, float, float]:
        """A pose drawn evenly from the free floor, `margin_m` further from obstacles than needed."""
        wide = self.free & (self.clearance_m >= self.robot_radius_m + margin_m)
        rows, columns = np.nonzero(wide)
        if not len(rows):
            raise ValueError(f"no free floor is left with margin_m = {margin_m}; choose a smaller one")
        k = int(rng.integers(len(rows)))
        x, y = self.point((int(rows[k]), int(columns[k])))
        return x, y, float(rng.uniform(-math.pi, math.pi))

    def shortest_path(self, start: Point, goal: Point) -> list[Point]:
        """Shortest collision-free way on the grid, straightened where that is free; empty if there is none.

        A point off the free floor (a robot a cell too near a wall) starts from the nearest free cell.
        """
        came = shortest_cells(self.free, self._nearest(start), self._nearest(goal))
        if not came:
            return []
        cells = [self.point(cell) for cell in came]
        return self._straightened([start, *cells[1:-1], goal])

    def shortest_path_m(self, start: Point, goal: Point) -> float:
        """Length of `shortest_path`, infinite if there is none."""
        path = self.shortest_path(start, goal)
        return sum(math.dist(a, b) for a, b in pairwise(path)) if path else math.inf

    def is_free_way(self, a: Point, b: Point) -> bool:
        """Whether the robot's centre can go straight from one point to another."""
        count = max(2, math.ceil(math.dist(a, b) / (self.resolution_m / 2)))
        return all(
            self.is_free((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
            for t in np.linspace(0.0, 1.0, count + 1)
        )

    def in_view(self, a: Point, b: Point) -> bool:
        """Whether pictures of two points show the same: a table or a chair between them is looked over."""
        return self.line_of_sight(a, b) or self.line_of_sight(a, b, CAMERA_M + LOOKED_OVER_M)

    def line_of_sight(self, a: Point, b: Point, height_m: float = CAMERA_M) -> bool:
        """Whether no wall and no solid furniture stands between two points at a height."""
        return not _blocked(self.parts, (*a, height_m), (*b, height_m))

    def _nearest(self, point: Point) -> tuple[int, int]:
        if self.is_free(point):
            return self.cell(point)
        rows, columns = np.nonzero(self.free)
        row, column = self.cell(point)
        k = int(np.argmin((rows - row) ** 2 + (columns - column) ** 2))
        return int(rows[k]), int(columns[k])

    def _straightened(self, path: list[Point]) -> list[Point]:
        kept, k = [path[0]], 0
        while k < len(path) - 1:
            ahead = len(path) - 1
            while ahead > k + 1 and not self.is_free_way(path[k], path[ahead]):
                ahead -= 1
            kept.append(path[ahead])
            k = ahead
        return kept


def free_space(
    world: WorldFile,
    robot_radius_m: float = 0.26,
    resolution_m: float | None = None,
    parts: tuple[Part, ...] | None = None,
) -> FreeSpace:
    """Grid of the floor where a disc of the robot's radius fits, connected to the world's start.

    Args:
        world: the world.
        robot_radius_m: of the disc.
        resolution_m: side of a cell; None takes a finer one for small worlds.
        parts: those of the world, where they are known.
    """
    whole = ground_clearance(world, robot_radius_m, resolution_m, parts)
    return replace(whole, free=_flood(whole.free, whole.cell((world.start.x_m, world.start.y_m))))


def ground_clearance(
    world: WorldFile,
    robot_radius_m: float = 0.26,
    resolution_m: float | None = None,
    parts: tuple[Part, ...] | None = None,
) -> FreeSpace:
    """The same with all floor where the disc fits, whether one gets there from the start or not."""
    parts = expand(world)[0] if parts is None else parts
    rects = world.rectangles()
    x0, y0 = min(r[0][0] for r in rects), min(r[1][0] for r in rects)
    x1, y1 = max(r[0][1] for r in rects), max(r[1][1] for r in rects)
    if resolution_m is None:
        resolution_m = FINE_M if max(x1 - x0, y1 - y0) <= SMALL_WORLD_M else COARSE_M
    xs = np.arange(x0, x1 + resolution_m / 2, resolution_m)
    ys = np.arange(y0, y1 + resolution_m / 2, resolution_m)
    inside = floor_grid(world, parts, xs, ys)
    clearance = np.where(inside, clearance_grid_m(xs, ys, footprints(parts, *BODY_BAND_M), FAR_M), 0.0)
    origin = (float(x0), float(y0))
    return FreeSpace(clearance >= robot_radius_m, clearance, origin, resolution_m, robot_radius_m, parts)


def _flood(free: npt.NDArray[np.bool_], start: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """The 4-connected part of `free` that holds `start`."""
    if not free[start]:
        raise ValueError(
            "the world's start is not on free floor: move it at least a robot radius away from everything"
        )
    _, labels = cv2.connectedComponents(free.astype(np.uint8), connectivity=4)
    return np.asarray(labels == labels[start])


def _blocked(parts: tuple[Part, ...], a: tuple[float, float, float], b: tuple[float, float, float]) -> bool:
    """Whether the segment a-b meets a solid part; ornaments, leaves and cloth hide too little to count."""
    start, delta = np.array(a), np.array(b) - np.array(a)
    for part in parts:
        if not part.solid:
            continue
        rotation = rotation_of(part)
        local, step = rotation.T @ (start - np.array(part.centre_m)), rotation.T @ delta
        step = np.where(np.abs(step) < 1e-12, 1e-12, step)
        half = np.array(part.size_m) / 2
        t0, t1 = (-half - local) / step, (half - local) / step
        near, far = np.minimum(t0, t1).max(), np.maximum(t0, t1).min()
        if near > far or far < 0.0 or near > 1.0:
            continue
        if part.shape != "hull" or _crosses(np.array(part.outline_m), local[:2], step[:2]):
            return True
    return False


def _crosses(outline: FloatArray, start: FloatArray, step: FloatArray) -> bool:
    """Whether a segment meets a convex outline, (corners, 2) counter-clockwise, by clipping at its edges."""
    along = np.roll(outline, -1, axis=0) - outline
    normals = np.stack([along[:, 1], -along[:, 0]], axis=-1)
    room, speed = ((outline - start) * normals).sum(axis=1), normals @ step
    if (room[np.abs(speed) < 1e-12] < 0.0).any():
        return False
    entering, leaving = speed < -1e-12, speed > 1e-12
    near = float((room[entering] / speed[entering]).max(initial=0.0))
    far = float((room[leaving] / speed[leaving]).min(initial=1.0))
    return near <= far
