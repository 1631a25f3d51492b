"""A room as a 360-degree camera sees it that leans in it: walls of painted panels, floor and ceiling."""

import numpy as np

from shared.geometry.perspective import pixel_centres
from shared.geometry.sphere import EquirectGrid

SIZE_M = np.array([5.0, 4.0, 2.6])
CAMERA_M = np.array([0.6, -0.4, -0.3])
"""From the middle of the room."""
PANEL_M = 0.35
FINE = 2
"""Pictures are drawn so much larger, each ray somewhere in its pixel: real edges have no stairs."""


def room(
    rotation_room_camera: np.ndarray, width_px: int = 1024, noise: float = 2.0, seed: int = 0
) -> np.ndarray:
    """What a camera sees.

    Args:
        rotation_room_camera: (3, 3), maps its bearings to the room's.
        width_px: columns.
        noise: standard deviation, levels.
        seed: of the paint and the noise.

    Returns:
        Its panorama (W / 2, W, 3), BGR.
    """
    rng = np.random.default_rng(seed)
    grid = EquirectGrid(FINE * width_px, FINE * width_px // 2)
    pixels = pixel_centres(FINE * width_px, FINE * width_px // 2)
    bearings = grid.bearings_from_pixels(pixels + rng.uniform(-0.5, 0.5, pixels.shape))
    bearings = bearings @ rotation_room_camera.T
    with np.errstate(divide="ignore"):
        reach = np.where(bearings > 0.0, 0.5 * SIZE_M - CAMERA_M, -0.5 * SIZE_M - CAMERA_M) / bearings
    wall = np.argmin(reach, axis=-1)
    there = CAMERA_M + bearings * np.min(reach, axis=-1)[..., None]
    side = np.take_along_axis(bearings, wall[..., None], axis=-1)[..., 0] > 0.0
    panels = np.floor(there / PANEL_M).astype(int) + 20
    colours = rng.integers(60, 200, (6, 40, 40, 3))
    others = np.array([[1, 2], [0, 2], [0, 1]])[wall]
    index = np.take_along_axis(panels, others, axis=-1)
    fine = colours[wall * 2 + side, index[..., 0], index[..., 1]].astype(np.float64)
    shape = width_px // 2, FINE, width_px, FINE, 3
    picture = fine.reshape(shape).mean(axis=(1, 3)) + rng.normal(0.0, noise, (width_px // 2, width_px, 3))
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)
