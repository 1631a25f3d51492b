"""Pictures of ROS as panoramas, and what is none."""

import io

import numpy as np
import pytest
from PIL import Image

from services.ros.conversions.header import ConversionError
from services.ros.conversions.picture import panorama_of
from tests.ros_messages import CODEC, IMAGE, PICTURE

RED_AHEAD = np.zeros((8, 16, 3), np.uint8)
RED_AHEAD[:, 8] = (255, 0, 0)  # RGB, one column


def compressed(rgb=RED_AHEAD, form="PNG"):
    file = io.BytesIO()
    Image.fromarray(rgb).save(file, form)
    return CODEC.make(PICTURE, format=form.lower(), data=np.frombuffer(file.getvalue(), np.uint8))


def raw(pixels, encoding, step=None):
    height, width = pixels.shape[:2]
    data = np.frombuffer(pixels.tobytes(), np.uint8)
    return CODEC.make(
        IMAGE, height=height, width=width, encoding=encoding, step=step or data.size // height, data=data
    )


def pixels_of(panorama):
    return np.frombuffer(panorama.data, np.uint8).reshape(panorama.height_px, panorama.width_px, 3)


def test_a_jpeg_that_looks_ahead_goes_through_as_it_came():
    message = compressed(form="JPEG")
    told = panorama_of(message, PICTURE, 0.5)
    assert (told.encoding, told.width_px, told.height_px) == ("jpeg", 16, 8)
    assert told.data == message.data.tobytes()


def test_a_png_becomes_blue_green_red():
    told = panorama_of(compressed(), PICTURE, 0.5)
    assert told.encoding == "bgr8"
    assert pixels_of(told)[3, 8].tolist() == [0, 0, 255]


def test_a_camera_that_looks_to_the_side_is_turned_ahead():
    aside = np.roll(RED_AHEAD, -4, axis=1)  # a quarter to the left of the middle
    assert np.array_equal(pixels_of(panorama_of(compressed(aside), PICTURE, 0.25)), RED_AHEAD[:, :, ::-1])


@pytest.mark.parametrize(
    ("encoding", "pixels"),
    [
        ("bgr8", RED_AHEAD[:, :, ::-1]),
        ("rgb8", RED_AHEAD),
        ("rgba8", np.dstack([RED_AHEAD, np.full((8, 16), 255, np.uint8)])),
        ("bgra8", np.dstack([RED_AHEAD[:, :, ::-1], np.full((8, 16), 255, np.uint8)])),
    ],
)
def test_all_usual_encodings_become_the_same_picture(encoding, pixels):
    told = panorama_of(raw(np.ascontiguousarray(pixels), encoding), IMAGE, 0.5)
    assert np.array_equal(pixels_of(told), RED_AHEAD[:, :, ::-1])


def test_grey_pictures_and_rows_with_a_rest_are_read():
    rows = np.zeros((8, 20), np.uint8)
    rows[:, 8], rows[:, 16:] = 200, 99
    message = raw(rows, "mono8", step=20)
    message.width = 16
    assert pixels_of(panorama_of(message, IMAGE, 0.5))[0, 8].tolist() == [200] * 3


@pytest.mark.parametrize(
    ("message", "kind", "named"),
    [
        (compressed(np.zeros((12, 16, 3), np.uint8)), PICTURE, "exactly 2:1.*got 16 x 12"),
        (CODEC.make(PICTURE, data=np.zeros(9, np.uint8)), PICTURE, "a JPEG or PNG expected, 9 bytes"),
        (CODEC.make(PICTURE), PICTURE, "a JPEG or PNG expected, 0 bytes"),
        (raw(RED_AHEAD, "16UC1"), IMAGE, "encoding '16UC1': one of bgr8"),
        (raw(RED_AHEAD, "bgr8", step=40), IMAGE, "needs 320 bytes"),
        (raw(RED_AHEAD[:, :8], "bgr8"), IMAGE, "got 8 x 8"),
    ],
)
def test_what_is_no_panorama_is_named(message, kind, named):
    with pytest.raises(ConversionError, match=named):
        panorama_of(message, kind, 0.5)


def test_a_damaged_picture_is_named():
    message = compressed(np.tile(np.arange(16, dtype=np.uint8)[:, None, None], (1, 32, 3)))
    message.data = message.data[:60]
    with pytest.raises(ConversionError, match=r"damaged|JPEG or PNG"):
        panorama_of(message, PICTURE, 0.5)
