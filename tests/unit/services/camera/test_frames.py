"""From a picture to a frame: passed on where possible, stamped with its exposure, refused in one line."""

import cv2
import numpy as np
import pytest

from services.camera.frames import FrameMaker, FrameSettings
from services.camera.mount.orientation import Orientation
from services.camera.source import Picture
from shared.jpeg import BadPictureError, jpeg_size
from tests.fisheye_camera import FRONT_BACK
from tests.noisy_pictures import NoisyPictures, painted

NOW_NS = 1_700_000_000_000_000_000
JPEG = NoisyPictures(painted(512))()


def maker(orientation=None, fisheye=None, **changes):
    plain = {"robot": "r1", "width_px": 1920, "encoding": "jpeg", "jpeg_quality": 92}
    settings = FrameSettings(**(plain | {"delay_s": 0.0, "lockstep": False} | changes))
    return FrameMaker(settings, orientation or Orientation(), fisheye)


def test_a_jpeg_that_needs_nothing_is_passed_on_byte_by_byte():
    frame = maker().frame(Picture(JPEG, NOW_NS), 7)
    assert frame.data == JPEG
    assert (frame.seq, frame.width_px, frame.height_px, frame.encoding) == (7, 512, 256, "jpeg")


def test_a_frame_carries_the_time_of_its_exposure():
    assert maker(delay_s=0.4).frame(Picture(JPEG, NOW_NS), 0).stamp_ns == NOW_NS - 400_000_000


def test_a_picture_that_is_too_wide_is_scaled_down():
    frame = maker(width_px=128).frame(Picture(JPEG, NOW_NS), 0)
    assert (frame.width_px, frame.height_px) == (128, 64)
    assert jpeg_size(frame.data) == (128, 64)


def test_raw_frames_are_bgr_row_by_row():
    frame = maker(encoding="bgr8").frame(Picture(painted(256), NOW_NS), 0)
    rows = np.frombuffer(frame.data, np.uint8).reshape(128, 256, 3)
    np.testing.assert_array_equal(rows, painted(256))


def test_an_upside_down_camera_gives_upright_frames():
    upside = np.ascontiguousarray(painted(256)[::-1, ::-1])  # red stays ahead, blue is at the right
    upright = maker(Orientation(roll_rad=np.pi), encoding="bgr8").panorama(Picture(upside, NOW_NS))
    np.testing.assert_allclose(upright[64, 128], (0, 0, 255), atol=40)
    np.testing.assert_allclose(upright[64, 64], (255, 0, 0), atol=40)


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        ((480, 640, 3), r"expected, got 640 x 480: choose the camera's 360-degree output"),
        ((16, 32, 3), "got 32 x 16"),
    ],
)
def test_a_picture_that_is_no_panorama_is_refused(shape, said):
    with pytest.raises(BadPictureError, match=said):
        maker().frame(Picture(np.zeros(shape, np.uint8), NOW_NS), 0)


@pytest.mark.parametrize(
    "data", [b"", b"\xff\xd8", JPEG[:-300], b"\x89PNG" + JPEG], ids=["none", "start", "cut", "other"]
)
def test_a_damaged_jpeg_is_refused(data):
    with pytest.raises(BadPictureError):
        maker().frame(Picture(data, NOW_NS), 0)


def test_a_jpeg_that_says_it_is_huge_is_refused_before_it_is_decoded():
    start = JPEG.index(b"\xff\xc0") + 5
    huge = JPEG[:start] + (16_000).to_bytes(2) + (32_000).to_bytes(2) + JPEG[start + 4 :]
    with pytest.raises(BadPictureError, match="at most 64000000 pixels"):
        maker().frame(Picture(huge, NOW_NS), 0)


def test_fisheyes_of_another_shape_than_the_calibrated_are_refused():
    with pytest.raises(BadPictureError, match="shaped as the calibrated 1600 x 800 expected, got 512 x 512"):
        maker(fisheye=FRONT_BACK).frame(Picture(np.zeros((512, 512, 3), np.uint8), NOW_NS), 0)


def test_fisheyes_of_another_size_are_joined_all_the_same():
    small = cv2.resize(np.full((800, 1600, 3), 90, np.uint8), (800, 400))
    panorama = maker(fisheye=FRONT_BACK, width_px=256).panorama(Picture(small, NOW_NS))
    assert panorama.shape == (128, 256, 3)
    assert np.median(panorama) == 90
