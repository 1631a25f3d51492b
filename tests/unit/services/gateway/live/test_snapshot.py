"""Frames of the bus as JPEG."""

import io

import numpy as np
import pytest
from PIL import Image

from services.gateway.live.snapshot import jpeg_of
from shared.messages.sensors import Frame
from shared.web.problems import ProblemError


def raw(width: int = 256) -> Frame:
    pixels = np.zeros((width // 2, width, 3), np.uint8)
    pixels[:, :, 2] = 250  # red, last in bgr
    return Frame(robot="r1", encoding="bgr8", width_px=width, height_px=width // 2, data=pixels.tobytes())


def packed(width: int = 256, claimed: int | None = None) -> Frame:
    claimed = claimed or width
    out = io.BytesIO()
    Image.new("RGB", (width, width // 2), (250, 0, 0)).save(out, "JPEG")
    return Frame(robot="r1", encoding="jpeg", width_px=claimed, height_px=claimed // 2, data=out.getvalue())


@pytest.mark.parametrize("frame", [raw(), packed()])
@pytest.mark.parametrize(("asked", "expected"), [(None, 256), (128, 128), (4000, 256), (101, 100)])
def test_width_is_followed_and_never_exceeds_the_frame(
    frame: Frame, asked: int | None, expected: int
) -> None:
    picture = Image.open(io.BytesIO(jpeg_of(frame, asked)))
    assert picture.size == (expected, expected // 2)
    red, green, blue = picture.convert("RGB").getpixel((10, 10))  # type: ignore[misc]
    assert red > 240
    assert max(green, blue) < 20


def test_a_jpeg_that_fits_passes_unchanged() -> None:
    frame = packed()
    assert jpeg_of(frame, None) == frame.data


def test_a_jpeg_that_lies_about_its_size_is_refused() -> None:
    with pytest.raises(ProblemError):
        jpeg_of(packed(256, claimed=512), None)
