"""Folders and videos: in order, at a rate or stepped, and what cannot be read is named."""

import threading
import time

import cv2
import numpy as np
import pytest

from services.camera.kinds import find_camera
from services.camera.source import EndOfPicturesError, SourceError
from shared.jpeg import BadPictureError
from tests.noisy_pictures import NoisyPictures, painted


def opened(text):
    return find_camera(text).opener(threading.Event())()


@pytest.fixture
def folder(tmp_path):
    for name, shade in (("b.png", 20), ("a.png", 10), ("c.png", 30)):
        cv2.imwrite(str(tmp_path / name), np.full((64, 128, 3), shade, np.uint8))
    (tmp_path / "notes.txt").write_text("no picture")
    return tmp_path


def test_a_folder_is_played_in_the_order_of_its_names(folder):
    source = opened(f"{folder}?step=true")
    assert [int(source.read().data[0, 0, 0]) for _ in range(3)] == [10, 20, 30]
    with pytest.raises(EndOfPicturesError, match="no further picture"):
        source.read()


def test_a_loop_begins_again(folder):
    source = opened(f"{folder}?step=true&loop=true")
    assert [int(source.read().data[0, 0, 0]) for _ in range(4)] == [10, 20, 30, 10]


def test_a_rate_is_kept(folder):
    source = opened(f"{folder}?rate=20&loop=true")
    began_s = time.monotonic()
    for _ in range(5):
        source.read()
    assert time.monotonic() - began_s >= 0.19


def test_a_jpeg_stays_as_it_is(tmp_path):
    jpeg = NoisyPictures(painted(128))()
    (tmp_path / "one.JPG").write_bytes(jpeg)
    assert opened(f"{tmp_path}?step=1").read().data == jpeg


def test_a_video_file_is_played(tmp_path):
    file = tmp_path / "drive.avi"
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (128, 64))
    for shade in (40, 80, 120):
        writer.write(np.full((64, 128, 3), shade, np.uint8))
    writer.release()
    source = opened(f"{file}?step=true")
    shades = [float(np.median(source.read().data)) for _ in range(3)]
    np.testing.assert_allclose(shades, (40, 80, 120), atol=4)
    with pytest.raises(EndOfPicturesError):
        source.read()
    source.close()


@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n" + b"\xff" * 40, b"GIF89a" * 20])
def test_a_file_that_is_no_picture_is_named(tmp_path, data):
    (tmp_path / "x.png").write_bytes(data)
    with pytest.raises(BadPictureError, match=r"x\.png"):
        opened(f"{tmp_path}?step=1").read()


def test_an_empty_folder_and_a_missing_one_are_named(tmp_path):
    with pytest.raises(SourceError, match=r"a folder with \.jpg or \.png pictures expected"):
        opened(str(tmp_path))
    with pytest.raises(SourceError, match=r"expected, .*/none is neither"):
        opened(str(tmp_path / "none"))
