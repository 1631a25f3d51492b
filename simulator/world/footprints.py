"""Floor outlines of solid parts, and distances to them. Pure; distance sensors and free space build on it."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from shared.geometry.perspective import rotation_z
from simulator.scene.parts import Part, solids_between

FloatArray = npt.NDArray[np.float64]
ROUNDING_M = 1e-9


def _no_polygons() -> FloatArray:
    return np.zeros((0, 3, 2))


@dataclass(frozen=True)
class Footprints:
    """Outlines of solids: n rectangles (centre, half size, yaw), m discs (centre, radius), k polygons.

    Metres and radians. Polygons are (k, corners, 2), convex, counter-clockwise; shorter ones repeat their
    last corner.
    """

    centres_m: FloatArray
    halves_m: FloatArray
    yaws_rad: FloatArray
    disc_centres_m: FloatArray
    disc_radii_m: FloatArray
    polygons_m: FloatArray = field(default_factory=_no_polygons)

    def with_walkers(self, walking: "Footprints") -> "Footprints":
        """These outlines and those of what walks, which has rectangles and discs only."""
        return Footprints(
            np.concatenate([self.centres_m, walking.centres_m]),
            np.concatenate([self.halves_m, walking.halves_m]),
            np.concatenate([self.yaws_rad, walking.yaws_rad]),
            np.concatenate([self.disc_centres_m, walking.disc_centres_m]),
            np.concatenate([self.disc_radii_m, walking.disc_radii_m]),
            self.polygons_m,
        )

    def within(self, origin_m: FloatArray, reach_m: float) -> "Footprints":
        """Those that something within reach of a point (2,) may belong to."""
        far_m = np.hypot(*(self.centres_m - origin_m).T) - np.hypot(*self.halves_m.T)
        disc_far_m = np.hypot(*(self.disc_centres_m - origin_m).T) - self.disc_radii_m
        near, near_discs = far_m < reach_m, disc_far_m < reach_m
        return Footprints(
            self.centres_m[near],
            self.halves_m[near],
            self.yaws_rad[near],
            self.disc_centres_m[near_discs],
            self.disc_radii_m[near_discs],
            _within(self.polygons_m, origin_m, reach_m),
        )


def footprints(parts: tuple[Part, ...], low_m: float, high_m: float) -> Footprints:
    """Outlines of all solid parts that reach into the heights low_m..high_m."""
    solids = solids_between(parts, low_m, high_m)
    flat = [p for p in solids if p.shape not in ("cylinder", "hull")]
    round_ = [p for p in solids if p.shape == "cylinder"]
    return Footprints(
        np.array([p.centre_m[:2] for p in flat], float).reshape(-1, 2),
        np.array([(p.size_m[0] / 2, p.size_m[1] / 2) for p in flat], float).reshape(-1, 2),
        np.array([p.yaw_rad for p in flat], float),
        np.array([p.centre_m[:2] for p in round_], float).reshape(-1, 2),
        np.array([p.size_m[0] / 2 * max(1.0, p.taper) for p in round_], float),
        _stacked([hull_corners_m(p) for p in solids if p.shape == "hull"]),
    )


def hull_corners_m(part: Part) -> FloatArray:
    """Corners of a hull seen from above in its frame, (corners, 2) metres."""
    turned = np.array(part.outline_m) @ rotation_z(part.yaw_rad)[:2, :2].T
    return np.asarray(turned + np.array(part.centre_m[:2]))


def clearance_m(points_m: FloatArray, shapes: Footprints) -> FloatArray:
    """Distance from each of (n, 2) points to the nearest outline, 0 inside; (n,) metres."""
    best = np.full(len(points_m), np.inf)
    for centre, half, yaw in zip(shapes.centres_m, shapes.halves_m, shapes.yaws_rad, strict=True):
        local = _into(points_m - centre, yaw)
        outside = np.maximum(np.abs(local) - half, 0.0)
        np.minimum(best, np.hypot(outside[:, 0], outside[:, 1]), out=best)
    for centre, radius in zip(shapes.disc_centres_m, shapes.disc_radii_m, strict=True):
        delta = points_m - centre
        np.minimum(best, np.maximum(np.hypot(delta[:, 0], delta[:, 1]) - radius, 0.0), out=best)
    for corners in shapes.polygons_m:
        np.minimum(best, _polygon_distance_m(points_m, corners), out=best)
    return best


def clearance_grid_m(xs_m: FloatArray, ys_m: FloatArray, shapes: Footprints, far_m: float) -> FloatArray:
    """Distance from each point of a grid to the nearest outline, at most far_m; (len(ys), len(xs)) metres.

    Each outline is compared only with the points that are nearer to a box round it than to what came before,
    so that large worlds, and worlds of many outlines, take seconds.
    """
    best = np.full((len(ys_m), len(xs_m)), far_m)
    for low, high, one in _each(shapes):
        columns = slice(*np.searchsorted(xs_m, (low[0] - far_m, high[0] + far_m)))
        rows = slice(*np.searchsorted(ys_m, (low[1] - far_m, high[1] + far_m)))
        window, xs, ys = best[rows, columns], xs_m[columns], ys_m[rows]
        dx = np.maximum(np.maximum(low[0] - xs, xs - high[0]), 0.0)
        dy = np.maximum(np.maximum(low[1] - ys, ys - high[1]), 0.0)
        row, column = np.nonzero(dx[None] ** 2 + dy[:, None] ** 2 <= (window + ROUNDING_M) ** 2)
        if len(row):
            found = clearance_m(np.stack([xs[column], ys[row]], axis=-1), one)
            window[row, column] = np.minimum(window[row, column], found)
    return best


def _each(shapes: Footprints) -> Iterator[tuple[FloatArray, FloatArray, Footprints]]:
    """Every outline on its own, with the corners of a box round it."""
    none2, none1 = np.zeros((0, 2)), np.zeros(0)
    for centre, half, yaw in zip(shapes.centres_m, shapes.halves_m, shapes.yaws_rad, strict=True):
        reach = np.hypot(*half)
        yield (
            centre - reach,
            centre + reach,
            Footprints(centre[None], half[None], np.array([yaw]), none2, none1),
        )
    for centre, radius in zip(shapes.disc_centres_m, shapes.disc_radii_m, strict=True):
        disc = Footprints(none2, none2, none1, centre[None], np.array([radius]))
        yield centre - radius, centre + radius, disc
    for corners in shapes.polygons_m:
        hull = Footprints(none2, none2, none1, none2, none1, corners[None])
        yield corners.min(axis=0), corners.max(axis=0), hull


def cast_rays(origin_m: FloatArray, angles_rad: FloatArray, shapes: Footprints, max_m: float) -> FloatArray:
    """Distance along each of (n,) rays from one origin (2,) to the first outline, at most max_m; (n,) metres.

    Slab test for rectangles, quadratic for discs; a ray that starts inside an outline gives 0.
    """
    best = np.full(len(angles_rad), max_m)
    shapes = shapes.within(origin_m, max_m)
    if len(shapes.yaws_rad):
        start = _into(origin_m - shapes.centres_m, shapes.yaws_rad)
        relative = angles_rad[:, None] - shapes.yaws_rad[None, :]
        direction = np.stack([np.cos(relative), np.sin(relative)], axis=-1)
        direction = np.where(np.abs(direction) < 1e-12, 1e-12, direction)
        a = (-shapes.halves_m - start) / direction
        b = (shapes.halves_m - start) / direction
        near, far = np.minimum(a, b).max(axis=-1), np.maximum(a, b).min(axis=-1)
        hits = np.where((near <= far) & (far >= 0.0), np.maximum(near, 0.0), np.inf)
        best = np.minimum(best, hits.min(axis=1))
    if len(shapes.disc_radii_m):
        delta = shapes.disc_centres_m - origin_m
        unit = np.stack([np.cos(angles_rad), np.sin(angles_rad)], axis=-1)
        along = unit @ delta.T
        gap2 = (delta**2).sum(axis=1)[None, :] - along**2
        half = np.sqrt(np.maximum(shapes.disc_radii_m**2 - gap2, 0.0))
        hit = (gap2 <= shapes.disc_radii_m**2) & (along + half >= 0.0)
        best = np.minimum(best, np.where(hit, np.maximum(along - half, 0.0), np.inf).min(axis=1))
    if len(shapes.polygons_m):
        best = np.minimum(best, _cast_at_polygons(origin_m, angles_rad, shapes.polygons_m).min(axis=1))
    return best


def _stacked(polygons: list[FloatArray]) -> FloatArray:
    """Polygons of different length as one array: the last corner is repeated."""
    most = max((len(p) for p in polygons), default=3)
    padded = [np.concatenate([p, np.repeat(p[-1:], most - len(p), axis=0)]) for p in polygons]
    return np.array(padded).reshape(-1, most, 2)


def _within(polygons: FloatArray, origin_m: FloatArray, max_m: float) -> FloatArray:
    """The polygons whose bounding box is no further away than max_m."""
    if not len(polygons):
        return polygons
    gap = np.maximum(polygons.min(axis=1) - origin_m, origin_m - polygons.max(axis=1))
    return np.asarray(polygons[(gap < max_m).all(axis=1)])


def _edges(polygons: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Outward normals (k, corners, 2), zero at repeated corners, and offsets (k, corners): n x <= c."""
    along = np.roll(polygons, -1, axis=1) - polygons
    normals = np.stack([along[..., 1], -along[..., 0]], axis=-1)
    return normals, (normals * polygons).sum(axis=-1)


def _cast_at_polygons(origin_m: FloatArray, angles_rad: FloatArray, polygons: FloatArray) -> FloatArray:
    """Distances along rays to convex polygons by clipping at their edges, (rays, k); inf if missed."""
    normals, offsets = _edges(polygons)
    room = (offsets - normals @ origin_m)[None]  # positive: inside of that edge
    unit = np.stack([np.cos(angles_rad), np.sin(angles_rad)], axis=-1)
    speed = np.einsum("kcd,rd->rkc", normals, unit)
    parallel = np.abs(speed) < 1e-12
    t = room / np.where(parallel, 1.0, speed)
    enter = np.where(parallel, np.where(room < 0.0, np.inf, -np.inf), np.where(speed < 0.0, t, -np.inf))
    leave = np.where(parallel | (speed < 0.0), np.inf, t)
    near, far = enter.max(axis=-1), leave.min(axis=-1)
    return np.asarray(np.where((near <= far) & (far >= 0.0), np.maximum(near, 0.0), np.inf))


def _polygon_distance_m(points_m: FloatArray, corners: FloatArray) -> FloatArray:
    """Distance from (n, 2) points to one convex polygon, 0 inside; (n,)."""
    inside = np.ones(len(points_m), bool)
    squared = np.full(len(points_m), np.inf)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along, delta = b - a, points_m - a
        length2 = float(along @ along)
        if length2 == 0.0:
            continue
        inside &= along[0] * delta[:, 1] - along[1] * delta[:, 0] >= 0.0
        t = np.clip(delta @ along / length2, 0.0, 1.0)
        np.minimum(squared, ((delta - t[:, None] * along) ** 2).sum(axis=1), out=squared)
    return np.where(inside, 0.0, np.sqrt(squared))


def _into(delta: FloatArray, yaw: FloatArray | float) -> FloatArray:
    """Rotate (n, 2) world offsets into frames turned by yaw."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * delta[..., 0] + s * delta[..., 1], -s * delta[..., 0] + c * delta[..., 1]], axis=-1)
