"""Frames are distrusted: size before decoding, damage, announced size."""

import cv2
import numpy as np
import pytest

from shared.frames.decoding import decode_picture
from shared.jpeg import BadPictureError, jpeg_size
from shared.messages.sensors import Frame


def jpeg(width: int, height: int, *options: int) -> bytes:
    picture = np.random.default_rng(0).integers(0, 256, (height, width, 3), dtype=np.uint8)
    return cv2.imencode(".jpg", picture, list(options))[1].tobytes()


def frame(data: bytes, width: int = 64, height: int = 32, encoding: str = "jpeg") -> Frame:
    return Frame(robot="r1", encoding=encoding, width_px=width, height_px=height, data=data)


def with_size(data: bytes, width: int, height: int) -> bytes:
    """The JPEG with another size written into its frame header."""
    place = data.index(b"\xff\xc0") + 5
    return data[:place] + height.to_bytes(2) + width.to_bytes(2) + data[place + 4 :]


@pytest.mark.parametrize(
    "options", [(), (cv2.IMWRITE_JPEG_PROGRESSIVE, 1), (cv2.IMWRITE_JPEG_RST_INTERVAL, 2)]
)
def test_jpeg_size_is_read_from_the_header(options):
    assert jpeg_size(jpeg(64, 32, *options)) == (64, 32)


def test_bgr8_comes_back_as_sent():
    pixels = np.arange(64 * 32 * 3, dtype=np.uint32).astype(np.uint8)
    picture = decode_picture(frame(pixels.tobytes(), encoding="bgr8"))
    np.testing.assert_array_equal(picture.ravel(), pixels)


@pytest.mark.parametrize(("enough_px", "width"), [(None, 66), (40, 66), (33, 33), (16, 17), (1, 9)])
def test_jpeg_is_decoded_no_larger_than_needed(enough_px, width):
    picture = decode_picture(frame(jpeg(66, 33), 66, 33), enough_px)
    assert picture.shape[1] == width


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        pytest.param(b"", "must start with FF D8", id="empty"),
        pytest.param(b"GIF89a" * 10, "must start with FF D8", id="another format"),
        pytest.param(b"\xff\xd8", "no frame header", id="start only"),
        pytest.param(b"\xff\xd8" + b"\xff\xe0\x00\x00" * 40, "no frame header", id="segments of length zero"),
        pytest.param(b"\xff\xd8" + bytes(200), "no frame header", id="zeros"),
        pytest.param(jpeg(64, 32)[:-200], "cut short", id="truncated"),
        pytest.param(jpeg(128, 64), "announces 64 x 32, its JPEG is 128 x 64", id="another size"),
        pytest.param(with_size(jpeg(64, 32), 65535, 65535), "its JPEG is 65535 x 65535", id="bomb header"),
        pytest.param(jpeg(64, 32)[:200] + b"\xff\xd9", "no frame header|cannot be decoded", id="no data"),
    ],
)
def test_junk_is_refused_with_the_reason(data, reason):
    with pytest.raises(BadPictureError, match=reason):
        decode_picture(frame(data))


def test_a_picture_too_large_is_refused_before_decoding():
    with pytest.raises(BadPictureError, match="at most 64000000 pixels, got 16384 x 8192"):
        decode_picture(frame(b"\xff\xd8", 16_384, 8_192))


def test_segment_of_length_zero_cannot_loop():
    with pytest.raises(BadPictureError):
        jpeg_size(b"\xff\xd8" + b"\xff\xe1\xff\xff" * 3)
