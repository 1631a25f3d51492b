"""Tables that turn panoramas and join fisheyes: red lies ahead and blue to the left, whatever came in."""

import math

import cv2
import numpy as np
import pytest

from services.camera.mount.orientation import Orientation
from services.camera.mount.table import from_panorama
from shared.geometry.perspective import pixel_centres
from shared.geometry.sphere import EquirectGrid
from tests.noisy_pictures import painted

WIDTH = 256
RED, BLUE = (0, 0, 255), (255, 0, 0)


def seen_by(orientation: Orientation, panorama: np.ndarray) -> np.ndarray:
    """What a camera that sits so sees of the robot's panorama; written the slow way, apart from the table."""
    grid = EquirectGrid(WIDTH, WIDTH // 2)
    bearings = grid.bearings_from_pixels(pixel_centres(WIDTH, WIDTH // 2))
    if orientation.mirrored:
        bearings = bearings * np.array([1.0, -1.0, 1.0])
    pixels = grid.pixels_from_bearings(bearings @ orientation.rotation.T)
    u, v = np.floor(pixels[..., 0]).astype(int) % WIDTH, np.floor(pixels[..., 1]).astype(int)
    return panorama[np.clip(v, 0, WIDTH // 2 - 1), u]


@pytest.mark.parametrize(
    "orientation",
    [
        Orientation(heading_rad=1.0),
        Orientation(roll_rad=math.pi),
        Orientation(0.1, -0.2, 2.5),
        Orientation(mirrored=True),
        Orientation(0.3, 0.1, -1.0, mirrored=True),
    ],
    ids=["turned", "upside-down", "tilted", "mirrored", "all of it"],
)
def test_whatever_the_mount_red_comes_out_ahead_and_blue_to_the_left(orientation):
    table = from_panorama(WIDTH, WIDTH, orientation)
    result = table.applied(seen_by(orientation, painted(WIDTH)))
    np.testing.assert_allclose(result[WIDTH // 4, WIDTH // 2], RED, atol=40)
    np.testing.assert_allclose(result[WIDTH // 4, WIDTH // 4], BLUE, atol=40)


def test_the_left_and_the_right_edge_go_on_at_each_other():
    turned = from_panorama(WIDTH, WIDTH, Orientation(heading_rad=math.pi)).applied(painted(WIDTH))
    np.testing.assert_array_equal(turned[:, WIDTH // 2 :], painted(WIDTH)[:, : WIDTH // 2])


def test_a_larger_picture_is_scaled_in_the_same_step():
    larger = cv2.resize(painted(WIDTH), (2 * WIDTH, WIDTH), interpolation=cv2.INTER_NEAREST)
    result = from_panorama(WIDTH, 2 * WIDTH, Orientation()).applied(larger)
    np.testing.assert_array_equal(result, painted(WIDTH))
