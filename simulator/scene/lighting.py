"""Static light, computed once per vertex: direct with soft shadows, ambient with occlusion. Pure numpy.

The lamps never move, so the renderer only multiplies the texture by this (see shaders/baked): frames cost a
fraction of what lights and shadow maps cost, and look the same from everywhere. Shadows come from rays
marched through a grid of filled cells, whose cost does not grow with the number of things in a room.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simulator.scene.meshes import surface_points
from simulator.scene.parts import Light, Part, rotation_of

FloatArray = npt.NDArray[np.float32]
# Chosen by eye and by the seconds that a world takes to load (decision 0008).
CELL_M = 0.06
MOST_CELLS = 700  # along the longest side of a world: larger worlds get larger cells
OCCLUDER_M = 0.05  # thinner and smaller things cast no shadow
SHARE_M = 0.09  # vertices this near with the same normal share one computation
SAMPLES = 2  # points of a lamp
SOFT_M2 = 0.35  # keeps what is near a lamp from being infinitely bright
HEMISPHERE = 12  # directions in which a corner may be closed
REACH_M = 0.9  # how far that counts
SKIP_M = 0.07  # a surface does not shade itself
START_M = 0.02  # rays begin so far above it
CLEAR_SHARE = 0.006  # less light than this is not worth a ray
SHRINK = {"ellipsoid": 0.8, "cylinder": 0.9, "cushion": 0.96}  # of the boxes that stand for round things
WHITE, SHOULDER = 1.25, 0.8  # brightest factor, and the light that reaches 63 % of it
GAMMA = 1 / 2.2  # of the renderer's textures


@dataclass(frozen=True)
class Sunlight:
    """Parallel light: unit vector towards the sun, and its power (linear RGB)."""

    towards: tuple[float, float, float]
    power: tuple[float, float, float]


def bake(
    vertices: FloatArray, normals: FloatArray, parts: tuple[Part, ...], lights: tuple[Light, ...],
    ambient: tuple[float, float, float], occlusion: float, rng: np.random.Generator,
    sun: Sunlight | None = None, alike: bool = False,
) -> FloatArray:  # fmt: skip
    """Light at each vertex as a factor for gamma-encoded texture values.

    Direct light, at SAMPLES points of each lamp: power * max(cos_surface, 0) * cos_light / (SOFT_M2 + d^2).
    Ambient light is lost by up to `occlusion` where short rays over the hemisphere hit something.

    Args:
        vertices: (n, 3) world positions, metres.
        normals: (n, 3) outward unit normals.
        parts: everything that may cast a shadow.
        lights: area lights.
        ambient: even light, linear RGB.
        occlusion: 0 to 1.
        rng: places the light samples.
        sun: parallel light with hard shadows.
        alike: whether all lamps are sampled at the same points, so that equal rooms are lit equally.

    Returns:
        (n, 3) factors, about 0.2 to 1.3.
    """
    keys = np.concatenate([np.round(vertices / SHARE_M), np.round(normals * 2.0)], axis=1).astype(np.int32)
    _, first, back = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    start, facing = vertices[first], normals[first]
    grid = _FilledGrid(parts, vertices)
    total = np.zeros((len(start), 3), np.float32)
    samples = [rng.uniform(-0.45, 0.45, (SAMPLES, 3)) for _ in lights]
    for light, shares in zip(lights, samples[:1] * len(lights) if alike else samples, strict=True):
        for point in np.array(light.centre_m) + shares * np.array(light.size_m):
            total += _direct(start, facing, grid, light, point.astype(np.float32)) / SAMPLES
    if sun is not None:
        total += _sunlit(start, facing, grid, sun)
    total += (
        np.array(ambient, np.float32) * (1.0 - occlusion * (1.0 - _openness(start, facing, grid)))[:, None]
    )
    # Soft shoulder: bright spots under lamps keep their texture.
    factors = (WHITE * (1.0 - np.exp(-total / SHOULDER))) ** GAMMA
    return np.asarray(factors[back.reshape(-1)], np.float32)


def _sunlit(start: FloatArray, normals: FloatArray, grid: "_FilledGrid", sun: Sunlight) -> FloatArray:
    """Parallel light: where nothing stands between a vertex and the sun."""
    towards = np.array(sun.towards, np.float32)
    cosine = np.maximum(normals @ towards, 0.0)
    lit = np.flatnonzero(cosine > 0.0)
    visible = np.zeros(len(start), np.float32)
    begin = start[lit] + START_M * normals[lit]
    visible[lit] = ~grid.hit(begin, begin + towards * grid.way_out_m(begin, towards)[:, None])
    return np.asarray((cosine * visible)[:, None] * np.array(sun.power, np.float32), np.float32)


def _direct(
    start: FloatArray, normals: FloatArray, grid: "_FilledGrid", light: Light, point: FloatArray
) -> FloatArray:
    delta = point - start
    squared = (delta**2).sum(axis=1)
    unit = delta / np.sqrt(squared)[:, None]
    cosine = np.maximum((unit * normals).sum(axis=1), 0.0)
    if light.facing is not None:
        cosine = cosine * np.maximum(-(unit @ np.array(light.facing, np.float32)), 0.0)
    strength = cosine / (SOFT_M2 + squared)
    lit = np.flatnonzero(strength > CLEAR_SHARE)
    visible = np.zeros(len(start), np.float32)
    begin = start[lit] + START_M * normals[lit]
    visible[lit] = ~grid.hit(begin, grid.ends_inside(begin, _before(begin, point, light.clear_m)))
    return np.asarray((strength * visible)[:, None] * np.array(light.power, np.float32), np.float32)


def _before(start: FloatArray, point: FloatArray, clear_m: float) -> FloatArray:
    """Where rays from (n, 3) points end that need not come nearer to a point than `clear_m`."""
    delta = point - start
    length = np.maximum(np.linalg.norm(delta, axis=1, keepdims=True), 1e-6)
    return np.asarray(start + delta * np.maximum(1.0 - clear_m / length, 0.0), np.float32)


def _openness(start: FloatArray, normals: FloatArray, grid: "_FilledGrid") -> FloatArray:
    """Share of HEMISPHERE directions, cosine-weighted, that are free for REACH_M."""
    k = np.arange(HEMISPHERE) + 0.5
    radius, angle = np.sqrt(k / HEMISPHERE), np.pi * (1 + 5**0.5) * k
    local = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1 - radius**2)], axis=-1
    ).astype(np.float32)
    helper = np.where(
        np.abs(normals[:, :1]) > 0.9, np.array([[0, 1, 0]], np.float32), np.array([[1, 0, 0]], np.float32)
    )
    tangent = np.cross(helper, normals)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-6)
    bitangent = np.cross(normals, tangent)
    free = np.zeros(len(start), np.float32)
    origin = start + START_M * normals
    for a, b, c in local:
        free += ~grid.hit(origin, origin + (a * tangent + b * bitangent + c * normals) * np.float32(REACH_M))
    return np.asarray(free / HEMISPHERE, np.float32)


class _FilledGrid:
    """Cells of the world that parts fill."""

    def __init__(self, parts: tuple[Part, ...], vertices: FloatArray) -> None:
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        self._cell_m = max(CELL_M, float((high - low).max()) / MOST_CELLS)
        margin = REACH_M + 2 * self._cell_m  # rays may leave the building a little
        self._low, self._high = low - margin, high + margin
        shape = np.ceil((high + margin - self._low) / self._cell_m).astype(int) + 1
        self._filled = np.zeros(shape, bool)
        for part in parts:
            if part.casts_shadow and part.shape != "leaf" and np.median(part.size_m) > OCCLUDER_M:
                self._fill(part, np.array(part.size_m) / 2 * SHRINK.get(part.shape, 1.0))

    def _fill(self, part: Part, half: npt.NDArray[np.float64]) -> None:
        """Fill every cell that holds a sample point of the part; samples are denser than cells."""
        axes = [np.linspace(-h, h, max(2, int(np.ceil(2 * h / (0.7 * self._cell_m))) + 1)) for h in half]
        local = (
            np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
            if part.geometry is None
            else surface_points(part.geometry.mesh, 0.7 * self._cell_m)
        )
        points = local @ rotation_of(part).T + np.array(part.centre_m)
        i, j, k = np.clip(
            ((points - self._low) / self._cell_m).astype(int), 0, np.array(self._filled.shape) - 1
        ).T
        self._filled[i, j, k] = True

    def ends_inside(self, start: FloatArray, end: FloatArray) -> FloatArray:
        """Ends of segments from (n, 3) points inside, where the grid ends for those that leave it."""
        low, high = self._low + self._cell_m, self._high - self._cell_m
        outside = np.flatnonzero(((end < low) | (end > high)).any(axis=1))
        if not len(outside):
            return end
        begin, delta = start[outside], end[outside] - start[outside]
        room = np.where(delta > 0.0, high - begin, low - begin)
        moving = np.abs(delta) > 1e-6
        share = np.where(moving, room / np.where(moving, delta, 1.0), np.inf).min(axis=1)
        inside = end.copy()
        inside[outside] = begin + delta * np.clip(share, 0.0, 1.0)[:, None]
        return inside

    def way_out_m(self, start: FloatArray, unit: FloatArray) -> FloatArray:
        """Distance along one direction until the grid ends, from each of (n, 3) points inside; (n,)."""
        ends = np.where(unit > 0.0, self._high, self._low) - start
        steps = np.where(np.abs(unit) > 1e-6, ends / np.where(np.abs(unit) > 1e-6, unit, 1.0), np.inf)
        return np.asarray(np.maximum(steps.min(axis=1) - self._cell_m, 0.0), np.float32)

    def hit(self, start: FloatArray, end: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether each segment from start (n, 3) to end meets a filled cell beyond its first SKIP_M; (n,)."""
        delta = end - start
        length = np.linalg.norm(delta, axis=1)
        order = np.argsort(length)
        cell_m = self._cell_m
        unit = delta / np.maximum(length, 1e-6)[:, None] / cell_m
        base = (start - self._low) / cell_m
        blocked = np.zeros(len(start), bool)
        skip_m = max(SKIP_M, 1.1 * cell_m)
        for step in np.arange(skip_m, float(length.max(initial=0.0)) - cell_m, cell_m):
            # Rays sorted by length: those that have ended are at the front.
            live = order[np.searchsorted(length[order], step + cell_m) :]
            live = live[~blocked[live]]
            cells = (base[live] + unit[live] * np.float32(step)).astype(np.int32)
            blocked[live] = self._filled[cells[:, 0], cells[:, 1], cells[:, 2]]
        return blocked
