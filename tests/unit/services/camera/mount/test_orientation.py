"""How a camera sits on a robot."""

import math

import numpy as np
import pytest

from services.camera.mount.orientation import Orientation, levelled


@pytest.mark.parametrize(
    ("orientation", "camera", "robot"),
    [
        (Orientation(heading_rad=math.pi / 2), (1, 0, 0), (0, 1, 0)),
        (Orientation(roll_rad=0.1), (0, 1, 0), (0, math.cos(0.1), math.sin(0.1))),
        (Orientation(pitch_rad=0.1), (1, 0, 0), (math.cos(0.1), 0, -math.sin(0.1))),
        (Orientation(roll_rad=math.pi), (0, 0, 1), (0, 0, -1)),
    ],
    ids=["heading turns left", "roll lifts the left side", "pitch puts the nose down", "upside-down"],
)
def test_each_angle_means_what_its_setting_says(orientation, camera, robot):
    np.testing.assert_allclose(orientation.rotation @ np.array(camera, float), robot, atol=1e-12)


def test_what_is_measured_as_up_becomes_up():
    tilted = Orientation(0.2, -0.1, 0.7)
    found = levelled(tilted.up, tilted)
    np.testing.assert_allclose((found.roll_rad, found.pitch_rad), (0.2, -0.1), atol=1e-12)
    assert found.heading_rad == 0.7


def test_less_than_a_tenth_of_a_pixel_is_no_turn():
    assert Orientation(roll_rad=math.radians(0.04)).is_none
    assert not Orientation(roll_rad=math.radians(0.06)).is_none
    assert not Orientation(mirrored=True).is_none
