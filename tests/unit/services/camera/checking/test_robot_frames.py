"""Frames of a robot's bus are looked at as a camera's pictures are."""

import io

import cv2
import numpy as np
import pytest
from PIL import Image

from services.camera.checking.report import problems
from services.camera.checking.robot_frames import look_at
from shared.messages.sensors import Frame


def frame(picture, encoding="bgr8"):
    data = np.ascontiguousarray(picture).tobytes()
    if encoding == "jpeg":
        file = io.BytesIO()
        Image.fromarray(picture).save(file, "JPEG")
        data = file.getvalue()
    height, width = picture.shape[:2]
    return Frame(robot="r1", encoding=encoding, width_px=width, height_px=height, data=data)


@pytest.fixture
def picture(rng):
    """A panorama of blotches that goes all round."""
    noise = rng.integers(60, 200, (16, 32, 3), dtype=np.uint8)
    wide = cv2.resize(np.hstack([noise] * 3), (768, 128), interpolation=cv2.INTER_CUBIC)
    return np.ascontiguousarray(wide[:, 256:512])


@pytest.mark.parametrize("encoding", ["bgr8", "jpeg"])
def test_rate_size_and_coverage_are_told_and_the_last_one_is_marked(picture, encoding):
    frames = [frame(np.roll(picture, k, axis=1), encoding) for k in range(3)]
    report, png = look_at(frames, [0.0, 0.2, 0.4, 0.9], "r1")
    assert (report.width_px, report.height_px, report.pictures, report.repeated) == (256, 128, 4, 0)
    assert report.rate_hz == pytest.approx(3.33, abs=0.01)
    assert report.longest_pause_s == pytest.approx(0.5)
    assert report.blank == 0.0
    assert problems(report) == []
    assert Image.open(io.BytesIO(png)).width == 1600


def test_a_picture_whose_ends_do_not_meet_and_one_that_hangs_are_named(picture):
    torn = picture.copy()
    torn[:, 128:] = 255 - torn[:, 128:]
    report, _ = look_at([frame(torn)] * 3, [0.0, 0.2, 0.4], "r1")
    assert report.repeated == 2
    assert any("do not meet" in one for one in problems(report))
