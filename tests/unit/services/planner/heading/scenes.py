"""Exact two-frame scenes for the heading methods: features around a camera that moves at constant height."""

import numpy as np

from shared.geometry.sphere import wrap_rad


def deg(*rows):
    """(N, 2) longitude, latitude in radians from degrees."""
    return np.deg2rad(np.array(rows, dtype=np.float64).reshape(-1, 2))


def ring(count=60, seed=0):
    """Features (count, 3) all around, metres, camera at the origin."""
    rng = np.random.default_rng(seed)
    angle, radius = rng.uniform(-np.pi, np.pi, count), rng.uniform(2.0, 5.0, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), rng.uniform(-1.0, 1.6, count)], axis=1)


def see(points, position=(0.0, 0.0), yaw_rad=0.0):
    """Longitudes and latitudes (N, 2) of points from a camera at `position`, turned by `yaw_rad`."""
    local = points - np.array([*position, 0.0])
    lon = wrap_rad(np.arctan2(local[:, 1], local[:, 0]) - yaw_rad)
    lat = np.arctan2(local[:, 2], np.hypot(local[:, 0], local[:, 1]))
    return np.stack([lon, lat], axis=1)
