"""Draws a textured room with pillars as a spherical camera sees it: rays, boxes and noise, numpy alone."""

import cv2
import numpy as np

from shared.geometry.sphere import EquirectGrid

HALF_SIZE_M = np.array([4.0, 3.0, 1.3])
PILLARS_M = ((2.2, 1.4, 0.35), (-1.8, 1.9, 0.3), (-2.5, -1.6, 0.4), (1.2, -2.1, 0.3))
PIXELS_PER_M = 60.0
BODY_LAT_RAD = np.deg2rad(-68.0)


def render_room(x_m: float, y_m: float, yaw_rad: float, height_px: int) -> np.ndarray:
    """(H, 2H, 3) BGR picture from (x, y), 1.3 m up, with a checkered robot body below -68 degrees."""
    grid = EquirectGrid(2 * height_px, height_px)
    u, v = np.meshgrid(np.arange(2 * height_px) + 0.5, np.arange(height_px) + 0.5)
    lonlat = grid.lonlat_from_pixels(np.stack([u, v], axis=-1))
    lon, lat = lonlat[..., 0] + yaw_rad, lonlat[..., 1]
    ray = np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)
    origin = np.array([x_m, y_m, 0.0])
    distance, axis = _leave_box(ray, origin)
    grey = _paint(origin + distance[..., None] * ray, axis)
    for number, (cx, cy, radius) in enumerate(PILLARS_M):
        near = _meet_pillar(ray, origin - np.array([cx, cy, 0.0]), radius)
        hit = near < distance
        point = origin + np.where(hit, near, 0.0)[..., None] * ray
        around = radius * np.arctan2(point[..., 1] - cy, point[..., 0] - cx)
        grey = np.where(hit, _texture(20 + number, around, point[..., 2]), grey)
        distance = np.minimum(distance, near)
    body = lat < BODY_LAT_RAD
    checks = 255.0 * ((np.floor(lonlat[..., 0] * 6.0) + np.floor(lat * 20.0)) % 2.0)
    grey = np.where(body, checks, grey)
    return np.repeat(grey.astype(np.uint8)[..., None], 3, axis=-1)


def _leave_box(ray: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance to the wall each ray meets and that wall's number, 0 to 5."""
    with np.errstate(divide="ignore"):
        per_axis = (np.sign(ray) * HALF_SIZE_M - origin) / ray
    axis = np.argmin(per_axis, axis=-1)
    side = np.take_along_axis(ray, axis[..., None], axis=-1)[..., 0] > 0
    return np.min(per_axis, axis=-1), 2 * axis + side


def _meet_pillar(ray: np.ndarray, origin: np.ndarray, radius: float) -> np.ndarray:
    """Distance to an upright cylinder round the z axis, infinite where it is missed."""
    a = ray[..., 0] ** 2 + ray[..., 1] ** 2
    b = ray[..., 0] * origin[0] + ray[..., 1] * origin[1]
    root = b * b - a * (origin[0] ** 2 + origin[1] ** 2 - radius**2)
    with np.errstate(invalid="ignore"):
        near = (-b - np.sqrt(root)) / a
    return np.where((root > 0.0) & (near > 0.0), near, np.inf)


def _paint(point: np.ndarray, wall: np.ndarray) -> np.ndarray:
    grey = np.zeros(wall.shape)
    for number in range(6):
        first, second = ((1, 2), (0, 2), (0, 1))[number // 2]
        grey = np.where(wall == number, _texture(number, point[..., first], point[..., second]), grey)
    return grey


def _texture(seed: int, s_m: np.ndarray, t_m: np.ndarray) -> np.ndarray:
    """Noise of four scales, sampled linearly at (s, t) metres."""
    rng = np.random.default_rng(seed)
    size = 600
    noise = np.zeros((size, size), np.float32)
    for cells, weight in ((12, 0.3), (40, 0.35), (120, 0.25), (size, 0.1)):
        layer = rng.random((cells, cells), dtype=np.float32)
        noise += weight * cv2.resize(layer, (size, size), interpolation=cv2.INTER_LINEAR)
    noise = np.clip((noise - 0.5) * 2.2 + 0.5, 0.0, 1.0) * 255.0
    at_s = np.mod(s_m * PIXELS_PER_M, size).astype(np.float32)
    at_t = np.mod(t_m * PIXELS_PER_M, size).astype(np.float32)
    return cv2.remap(noise, at_s, at_t, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP).astype(np.float64)
