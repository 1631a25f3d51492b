"""Floor outlines of solid parts, and distances to them. Pure; distance sensors and free space build on it."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simulator.parts import Part, solids_between

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Footprints:
    """Outlines of solids: n rectangles (centre, half size, yaw) and m discs (centre, radius); m, rad."""

    centres_m: FloatArray
    halves_m: FloatArray
    yaws_rad: FloatArray
    disc_centres_m: FloatArray
    disc_radii_m: FloatArray


def footprints(parts: tuple[Part, ...], low_m: float, high_m: float) -> Footprints:
    """Outlines of all solid parts that reach into the heights low_m..high_m."""
    solids = solids_between(parts, low_m, high_m)
    flat = [p for p in solids if p.shape != "cylinder"]
    round_ = [p for p in solids if p.shape == "cylinder"]
    return Footprints(
        np.array([p.centre_m[:2] for p in flat], float).reshape(-1, 2),
        np.array([(p.size_m[0] / 2, p.size_m[1] / 2) for p in flat], float).reshape(-1, 2),
        np.array([p.yaw_rad for p in flat], float),
        np.array([p.centre_m[:2] for p in round_], float).reshape(-1, 2),
        np.array([p.size_m[0] / 2 * max(1.0, p.taper) for p in round_], float),
    )


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
    return best


def cast_rays(origin_m: FloatArray, angles_rad: FloatArray, shapes: Footprints, max_m: float) -> FloatArray:
    """Distance along each of (n,) rays from one origin (2,) to the first outline, at most max_m; (n,) metres.

    Slab test for rectangles, quadratic for discs; a ray that starts inside an outline gives 0.
    """
    best = np.full(len(angles_rad), max_m)
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
    return best


def _into(delta: FloatArray, yaw: FloatArray | float) -> FloatArray:
    """Rotate (n, 2) world offsets into frames turned by yaw."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * delta[..., 0] + s * delta[..., 1], -s * delta[..., 0] + c * delta[..., 1]], axis=-1)
