"""Exposure that swings slowly about the right one, as automatic control does; highlights clip. Pure."""

import math

import cv2
import numpy as np

from simulator.disturbances.levels import generator
from simulator.sensors.panorama import Image

STOPS = 2.0  # of the largest error, at level 1: four times too bright or too dark
PERIOD_S = 24.0  # of the slower swing; chosen: several a room
FASTER = 0.37  # share of it of the faster one; chosen: no small ratio
GAMMA = 2.2  # of the picture


def stops(level: float, seed: int, time_s: float) -> float:
    """Error of the exposure in stops: two sine waves that a seed shifts."""
    first, second = generator(seed, "exposure").uniform(0.0, 2.0 * math.pi, 2)
    slow = math.sin(2.0 * math.pi * time_s / PERIOD_S + first)
    fast = math.sin(2.0 * math.pi * time_s / (FASTER * PERIOD_S) + second)
    return level * STOPS * (0.7 * slow + 0.3 * fast)


def exposed(picture: Image, error_stops: float) -> Image:
    """Multiply the linear light by 2^stops and clip; 0 stops return the picture as it is."""
    if error_stops == 0.0:
        return picture
    gain = 2.0 ** (error_stops / GAMMA)
    table = np.clip(np.round(np.arange(256) * gain), 0, 255).astype(np.uint8)
    return np.asarray(cv2.LUT(picture, table), np.uint8)
