"""A camera with two fisheyes in one picture whose lenses are known exactly, and pictures that it takes."""

import math
from collections.abc import Callable

import cv2
import numpy as np

from services.camera.mount.calibration_file import FisheyeCalibration, FisheyeLens
from shared.geometry.perspective import pixel_centres, rotation_y, rotation_z

LENS_PX = 800
"""Side of the square that each lens has in the picture."""
SEES_DEG = 100.0

FloatArray = np.ndarray
Colours = Callable[[FloatArray, FloatArray], FloatArray]
"""From origin (3,) and unit bearings (N, 3), camera frame, to colours (N, 3) from 0 to 255."""

AHEAD = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""R_camera_lens of a lens that looks exactly ahead: x right, y down, z ahead to x forward, y left, z up."""


def _lens(
    focal_px: float, centre: tuple[float, float], bend: tuple[float, float, float, float], turn: np.ndarray
) -> FisheyeLens:
    rotation = tuple(tuple(float(x) for x in row) for row in turn @ AHEAD)
    return FisheyeLens(
        focal_px=focal_px, centre_px=centre, distortion=bend, rotation=rotation, sees_deg=SEES_DEG
    )


FRONT_BACK = FisheyeCalibration(
    width_px=2 * LENS_PX,
    height_px=LENS_PX,
    lenses=(
        _lens(218.0, (403.2, 396.9), (0.012, -0.004, 0.0008, -0.0001), rotation_z(0.0)),
        _lens(
            215.5,
            (1196.1, 402.3),
            (0.018, -0.006, 0.001, -0.00012),
            rotation_z(math.pi + 0.011) @ rotation_y(0.008),
        ),
    ),
    error_px=0.0,
    pictures=1,
)
"""Two lenses back to back, neither centred nor exactly opposite, as they come out of a factory."""


def taken(colours: Colours, camera: FisheyeCalibration = FRONT_BACK, supersample: int = 2) -> np.ndarray:
    """The picture (H, W, 3) BGR of a scene; black where no lens looks."""
    fine = camera.scaled(camera.width_px * supersample)
    picture = np.zeros((fine.height_px, fine.width_px, 3), dtype=np.float32)
    half = fine.width_px // 2
    for number, one in enumerate(fine.lenses):
        pixels = pixel_centres(half, fine.height_px) + np.array([number * half, 0.0])
        bearings = one.lens.bearings(pixels)
        inside = bearings[..., 2] >= math.cos(math.radians(one.sees_deg))
        found = colours(np.zeros(3), bearings[inside] @ one.rotation_camera_lens.T)
        picture[:, number * half : (number + 1) * half][inside] = found
    small = cv2.resize(picture, (camera.width_px, camera.height_px), interpolation=cv2.INTER_AREA)
    return np.clip(np.rint(small), 0, 255).astype(np.uint8)
