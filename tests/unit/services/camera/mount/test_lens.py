"""The fisheye model: equation, both ways, and beyond a right angle."""

import math

import numpy as np
import pytest

from services.camera.mount.lens import Lens

BENT = Lens(300.0, (400.0, 390.0), (-0.03, 0.005, -0.001, 0.0002))


@pytest.mark.parametrize(
    ("bearing", "pixel"),
    [
        ((0.0, 0.0, 1.0), (400.0, 390.0)),
        ((1.0, 0.0, 0.0), (400.0 + 300.0 * math.pi / 2, 390.0)),
        ((0.0, 1.0, -1.0), (400.0, 390.0 + 300.0 * 3 * math.pi / 4)),
    ],
    ids=["axis", "right angle", "beyond"],
)
def test_an_undistorted_lens_counts_angles(bearing, pixel):
    pixels, _ = Lens(300.0, (400.0, 390.0)).pixels(np.array(bearing))
    np.testing.assert_allclose(pixels, pixel, atol=1e-9)


def test_the_distortion_is_the_published_polynomial():
    theta = 1.2
    k1, k2, k3, k4 = BENT.distortion
    expected = 300.0 * (theta + k1 * theta**3 + k2 * theta**5 + k3 * theta**7 + k4 * theta**9)
    assert BENT.radius_px(np.array(theta)) == pytest.approx(expected)


def test_a_pixel_comes_back_from_its_bearing_up_to_a_hundred_degrees(rng):
    theta, phi = rng.uniform(0.0, math.radians(100.0), 2000), rng.uniform(-math.pi, math.pi, 2000)
    sine = np.sin(theta)
    bearings = np.stack([sine * np.cos(phi), sine * np.sin(phi), np.cos(theta)], axis=-1)
    pixels, angles = BENT.pixels(bearings)
    np.testing.assert_allclose(angles, theta, atol=1e-9)
    np.testing.assert_allclose(BENT.bearings(pixels), bearings, atol=1e-9)


def test_a_lens_that_turns_back_is_noticed():
    assert BENT.grows_to(math.radians(100.0))
    assert not Lens(300.0, (0.0, 0.0), (-0.3, 0.0, 0.0, 0.0)).grows_to(math.radians(100.0))
