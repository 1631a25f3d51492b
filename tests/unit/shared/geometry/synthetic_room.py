"""Synthetic matches with known motion: a furnished room seen by an upright (or tilted) spherical camera."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.perspective import rotation_y, rotation_z
from shared.geometry.sphere import lonlat_from_bearings, wrap_rad

SIZE_M = np.array([8.0, 7.0, 2.6])
CAMERA_HEIGHT_M = 1.0


@dataclass(frozen=True, eq=False)
class Scene:
    """Matches (N, 2) of both frames and the truth about them."""

    current: np.ndarray
    target: np.ndarray
    heading_rad: float
    yaw_rad: float
    correct: np.ndarray


def make_scene(rng, count, outliers=0, distance_m=1.0, noise_deg=0.3, tilt_deg=0.0, max_lat_deg=65.0):
    """Draw a scene; outliers are shuffled matches of the same scene or uniform directions, half and half."""
    while True:
        points = _room_points(rng, 8 * count + 200)
        start = np.array([*rng.uniform(-1.5, 1.5, 2), 0.0])
        travel, yaw_c, yaw_t = rng.uniform(-np.pi, np.pi, 3)
        end = start + distance_m * np.array([np.cos(travel), np.sin(travel), 0.0])
        tilt = rotation_x(np.deg2rad(tilt_deg)) @ rotation_y(np.deg2rad(tilt_deg) / 2.0)
        current = _observe(rng, points, start, rotation_z(yaw_c), noise_deg)
        target = _observe(rng, points, end, rotation_z(yaw_t) @ tilt, noise_deg)
        limit = np.deg2rad(max_lat_deg)
        seen = (np.abs(current[:, 1]) < limit) & (np.abs(target[:, 1]) < limit)
        if seen.sum() >= count:
            break
    current, target = current[seen][:count].copy(), target[seen][:count].copy()
    target[:outliers] = _wrong(rng, target[:outliers])
    order = rng.permutation(count)
    return Scene(
        current[order],
        target[order],
        float(wrap_rad(travel - yaw_c)),
        float(wrap_rad(yaw_t - yaw_c)),
        (np.arange(count) >= outliers)[order],
    )


def rotation_x(angle_rad):
    """Rotation about x; a positive angle turns y towards z."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def error_deg(estimate_rad, truth_rad):
    return float(np.rad2deg(np.abs(wrap_rad(estimate_rad - truth_rad))))


def _room_points(rng, count):
    low, high = -SIZE_M / 2.0, SIZE_M / 2.0
    low[2], high[2] = -CAMERA_HEIGHT_M, SIZE_M[2] - CAMERA_HEIGHT_M
    points = rng.uniform(low, high, (count, 3))
    axis, side, wall = rng.integers(0, 3, count), rng.integers(0, 2, count), rng.random(count) < 0.8
    rows = np.flatnonzero(wall)
    points[rows, axis[rows]] = np.where(side[rows] == 1, high[axis[rows]], low[axis[rows]])
    return points[np.hypot(points[:, 0], points[:, 1]) > 0.3]


def _observe(rng, points, position, rotation, noise_deg):
    rays = (points - position) @ rotation
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return lonlat_from_bearings(rays + rng.normal(0.0, np.deg2rad(noise_deg), rays.shape))


def _wrong(rng, target):
    shuffled = target[rng.permutation(len(target))]
    uniform = np.stack([rng.uniform(-np.pi, np.pi, len(target)), rng.uniform(-1.1, 1.1, len(target))], axis=1)
    return np.where((np.arange(len(target)) % 2 == 0)[:, None], shuffled, uniform)
