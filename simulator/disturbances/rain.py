"""Rain: falling drops leave streaks, drops on the lens blur what is behind them. In the picture. Pure.

Streaks are straight lines in space, projected at both ends and between, so they bend in the spherical
picture as lines do: upright ones follow the columns, and near ones overhead spread over many.
"""

import math

import cv2
import numpy as np
import numpy.typing as npt

from simulator.disturbances.levels import generator
from simulator.sensors.panorama import Image

# Drops of 2 to 3 mm fall at 7 m/s (Gunn and Kinzer 1949); the rest by eye: a downpour at level 1.
STREAKS = 1800  # at level 1
NEAR_M, FAR_M = 0.5, 7.0
FALL_MPS, WIND_MPS, SHUTTER_S = 7.0, 1.5, 0.02
THICK_M = 0.004
BRIGHT = 0.55
LENS_DROPS = 40  # at level 1
LENS_KEEP_S = 4.0
LENS_RAD = (0.012, 0.035)
SHIFT = 4  # fraction bits of cv2's coordinates

FloatArray = npt.NDArray[np.float64]


def rained(picture: Image, level: float, seed: int, time_s: float) -> Image:
    """Streaks and lens drops on a picture, (height, width, 3); level 0 returns it as it is."""
    if level == 0.0:
        return picture
    drops = _lens(picture, level, seed, time_s)
    return _streaks(drops, level, generator(seed, "streaks", time_s))


def _streaks(picture: Image, level: float, rng: np.random.Generator) -> Image:
    height, width = picture.shape[:2]
    count = round(STREAKS * level)
    wind = rng.normal(0.0, WIND_MPS / 3, (count, 2)) + np.array([WIND_MPS, 0.0])
    velocity = np.column_stack([wind, np.full(count, -FALL_MPS)])
    radius = NEAR_M + (FAR_M - NEAR_M) * np.sqrt(rng.random(count))
    angle = rng.uniform(-math.pi, math.pi, count)
    middle = np.column_stack(
        [radius * np.cos(angle), radius * np.sin(angle), rng.uniform(-1.0, 1.0, count) * radius]
    )
    veil = np.zeros((height, width), np.uint8)
    steps = np.linspace(-0.5, 0.5, 5)[:, None, None] * SHUTTER_S
    columns, rows = _pixels(middle[None] + steps * velocity[None], width)
    for k in range(count):
        distance = float(np.linalg.norm(middle[k]))
        thick = max(1, round(THICK_M / distance * width / (2 * math.pi)))
        shade = int(np.clip(255 * BRIGHT * min(1.0, 3.0 / distance), 60, 255))
        line = np.column_stack([_unwrapped(columns[:, k], width), rows[:, k]])
        for turn in (0.0, -width, width):
            points = np.round((line + np.array([turn, 0.0])) * 2**SHIFT).astype(np.int32)
            if points[:, 0].max() >= 0 and points[:, 0].min() < width * 2**SHIFT:
                cv2.polylines(veil, [points], False, shade, thick, cv2.LINE_AA, SHIFT)
    weight = veil.astype(np.float32)[..., None] / 255.0
    return np.asarray(picture + weight * (225.0 - picture), np.uint8)


def _lens(picture: Image, level: float, seed: int, time_s: float) -> Image:
    """Discs on the sphere that stay for seconds; behind them the picture is blurred and a little brighter."""
    height, width = picture.shape[:2]
    age = math.floor(time_s / LENS_KEEP_S)
    rng = generator(seed, "lens", age)
    mask = np.zeros((height, width), np.uint8)
    for _ in range(round(LENS_DROPS * level)):
        longitude, latitude = rng.uniform(-math.pi, math.pi), math.asin(rng.uniform(-0.8, 1.0))
        size = rng.uniform(*LENS_RAD) * height / math.pi
        axes = (max(1, round(min(size / math.cos(latitude), width / 2))), max(1, round(size)))
        centre = (
            round((0.5 - longitude / (2 * math.pi)) * width),
            round((0.5 - latitude / math.pi) * height),
        )
        for turn in (0, -width, width):
            cv2.ellipse(mask, (centre[0] + turn, centre[1]), axes, 0.0, 0.0, 360.0, 255, -1, cv2.LINE_AA)
    weight = cv2.GaussianBlur(mask, (0, 0), max(1.0, width / 900)).astype(np.float32)[..., None] / 255.0
    side = max(3, width // 100)
    wide = cv2.copyMakeBorder(picture, 0, 0, side, side, cv2.BORDER_WRAP)
    soft = cv2.blur(wide, (side, side))[:, side:-side].astype(np.float32) * 0.95 + 14.0
    return np.asarray(picture + weight * (soft - picture), np.uint8)


def _pixels(points: FloatArray, width: int) -> tuple[FloatArray, FloatArray]:
    """Columns and rows of points around the camera, (..., 3) metres, as fractions of pixels."""
    longitude = np.arctan2(points[..., 1], points[..., 0])
    latitude = np.arctan2(points[..., 2], np.hypot(points[..., 0], points[..., 1]))
    columns = (0.5 - longitude / (2 * np.pi)) * width - 0.5
    return columns, (0.5 - latitude / np.pi) * (width / 2) - 0.5


def _unwrapped(columns: FloatArray, width: int) -> FloatArray:
    """Columns of one line without the jump at the seam."""
    return np.asarray(np.unwrap(columns, period=width))
