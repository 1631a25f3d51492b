"""What a camera that is not upright sees: equirectangular pictures sampled along turned bearings. Pure."""

import math

import cv2
import numpy as np

from services.features.pipeline.interfaces import Image
from shared.geometry.perspective import pixel_centres
from shared.geometry.sphere import EquirectGrid, FloatArray


def rotation_of(pitch_rad: float, roll_rad: float) -> FloatArray:
    """R_upright_tilted (3, 3): maps bearings of the tilted camera to those of the upright one.

    Rodrigues' rotation about the horizontal axis (roll, pitch, 0) by the root sum of squares: pitch is nose
    down, roll left up, as in the simulator.
    """
    turned, _ = cv2.Rodrigues(np.array([roll_rad, pitch_rad, 0.0]))
    return np.asarray(turned, np.float64)


def tilt(picture: Image, pitch_rad: float, roll_rad: float) -> Image:
    """The picture (H, 2H, 3) as the same camera would take it tilted, of the same size.

    Args:
        picture: equirectangular, centre column ahead.
        pitch_rad: nose down, radians.
        roll_rad: left side up, radians.
    """
    height, width = picture.shape[:2]
    grid = EquirectGrid(width, height)
    bearings = grid.bearings_from_pixels(pixel_centres(width, height))
    source = grid.pixels_from_bearings(bearings @ rotation_of(pitch_rad, roll_rad).T) - 0.5
    rows = np.clip(source[..., 1], 0.0, height - 1.0)
    return np.asarray(
        cv2.remap(
            picture,
            source[..., 0].astype(np.float32),
            rows.astype(np.float32),
            cv2.INTER_CUBIC,
            borderMode=cv2.BORDER_WRAP,
        ),
        np.uint8,
    )


def pitch_roll(angle_rad: float, axis_rad: float) -> tuple[float, float]:
    """Pitch and roll of a tilt by an angle about the horizontal axis at a longitude, radians."""
    return angle_rad * math.sin(axis_rad), angle_rad * math.cos(axis_rad)
