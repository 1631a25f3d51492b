"""How far a panorama is from level, told from upright edges."""

import math

import cv2
import numpy as np
import pytest

from services.camera.checking.level import level_of
from services.camera.mount.orientation import Orientation
from shared.geometry.sphere import angle_between_rad
from tests.painted_room import room


@pytest.mark.parametrize(("roll_deg", "pitch_deg"), [(0.0, 0.0), (1.0, -2.0), (-7.0, 4.0), (15.0, 12.0)])
def test_up_is_found_to_less_than_half_a_degree_however_the_camera_leans(roll_deg, pitch_deg):
    orientation = Orientation.from_degrees(roll_deg, pitch_deg, 30.0)
    level = level_of(room(orientation.rotation))
    assert level is not None
    assert math.degrees(float(angle_between_rad(level.up, orientation.up))) < 0.45
    assert 0.3 <= math.degrees(level.std_rad) < 0.45
    upright = np.array([0.0, 0.0, 1.0])
    assert level.lean_rad == pytest.approx(float(angle_between_rad(orientation.up, upright)), abs=0.008)


def test_what_has_no_upright_edges_is_not_told():
    rng = np.random.default_rng(1)
    assert level_of(np.full((256, 512, 3), 128, np.uint8)) is None
    blobs = cv2.GaussianBlur(rng.normal(128.0, 900.0, (512, 1024)), (0, 0), 6.0)
    assert level_of(np.clip(blobs, 0, 255).astype(np.uint8)) is None


def test_one_corner_alone_does_not_tell_how_it_leans():
    picture = np.full((512, 1024, 3), 128, np.uint8)
    picture[:, 500:520] = room(np.eye(3))[:, 500:520]
    assert level_of(picture) is None
