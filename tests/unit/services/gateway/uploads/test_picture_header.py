"""Size and format from the first bytes, for pictures Pillow writes and for what it would never write."""

import io
import struct

import pytest
from PIL import Image

from services.gateway.uploads.picture_header import HeaderError, read_header

SIZE = (130, 65)


def saved(kind: str, mode: str = "RGB", **options: object) -> bytes:
    out = io.BytesIO()
    Image.new(mode, SIZE).save(out, kind, **options)
    return out.getvalue()


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        pytest.param(saved("PNG"), "png", id="png"),
        pytest.param(saved("JPEG"), "jpeg", id="baseline jpeg"),
        pytest.param(saved("JPEG", progressive=True), "jpeg", id="progressive jpeg"),
        pytest.param(saved("JPEG", exif=b"Exif\x00\x00" + bytes(3000)), "jpeg", id="jpeg with exif"),
        pytest.param(saved("WEBP"), "webp", id="lossy webp"),
        pytest.param(saved("WEBP", lossless=True), "webp", id="lossless webp"),
        pytest.param(saved("WEBP", "RGBA", exif=b"Exif\x00\x00MM"), "webp", id="extended webp"),
    ],
)
def test_size_and_format_are_read(data: bytes, expected: str) -> None:
    assert read_header(data) == (expected, *SIZE)


def test_fill_bytes_before_a_jpeg_marker_are_skipped() -> None:
    data = saved("JPEG")
    assert read_header(data[:2] + b"\xff\xff\xff" + data[2:]) == ("jpeg", *SIZE)


def test_a_claimed_size_is_reported_without_a_single_pixel() -> None:
    header = b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 30_000, 30_000)
    assert read_header(header) == ("png", 30_000, 30_000)


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
def test_every_cut_of_the_header_is_an_error_not_a_crash(kind: str) -> None:
    data = saved(kind)
    for length in range(20):
        with pytest.raises(HeaderError):
            read_header(data[:length])


@pytest.mark.parametrize(
    "data",
    [
        b"<html></html>",
        b"GIF89a" + bytes(20),
        b"BM" + bytes(60),
        b"\x89PNG\r\n\x1a\n" + bytes(40),
        b"RIFF\x00\x00\x00\x00WEBPXXXX" + bytes(20),
        b"\xff\xd8\xff\xda" + bytes(20),
        b"\xff\xd8\xff\xe0\x00\x04ab" + bytes(20),
        b"\xff\xd8" + b"\xff" * 5000,
        b"\xff\xd8" + b"\xff\xe0\x00\x00" * 1000,
    ],
)
def test_other_content_is_refused(data: bytes) -> None:
    with pytest.raises(HeaderError):
        read_header(data)
