"""Format and size of a picture from its first bytes, read before any decoder sees it.

Decoders trust the size a file claims: a PNG of 109 kB can claim 30 000 x 30 000 pixels, and a WebP decoder
reserves its canvas as soon as it is opened. Layouts: PNG (W3C, 11.2.2 IHDR), JPEG (ITU T.81, B.2.2 frame
header), WebP (RFC 9649, 2.5 to 2.7).
"""

import struct
from typing import Literal, NamedTuple

Format = Literal["png", "jpeg", "webp"]

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
SOF_MARKERS = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
BARE_MARKERS = frozenset({0x01, *range(0xD0, 0xD8)})
"""Markers without a length: TEM and the restart markers."""


class HeaderError(ValueError):
    """The first bytes are not those of a PNG, JPEG or WebP picture."""


class PictureHeader(NamedTuple):
    """What a picture claims to be; sizes in pixels."""

    format: Format
    width_px: int
    height_px: int


def read_header(data: bytes) -> PictureHeader:
    """Read format and size.

    Raises:
        HeaderError: another format, or it ends before the size.
    """
    try:
        if data.startswith(PNG_SIGNATURE):
            return _png(data)
        if data.startswith(b"\xff\xd8\xff"):
            return _jpeg(data)
        if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
            return _webp(data)
    except (IndexError, struct.error):
        raise HeaderError("the picture ends within its header") from None
    raise HeaderError(f"the first bytes are {data[:8]!r}, not those of a PNG, JPEG or WebP")


def _png(data: bytes) -> PictureHeader:
    kind, width_px, height_px = struct.unpack_from(">4sII", data, 12)
    if kind != b"IHDR":
        raise HeaderError("PNG without an IHDR chunk at its start")
    return PictureHeader("png", width_px, height_px)


def _jpeg(data: bytes) -> PictureHeader:
    """Walk the segments up to the frame header."""
    at = 2
    while True:
        if data[at] != 0xFF:
            raise HeaderError(f"JPEG marker expected at byte {at}, got {data[at]:#04x}")
        while data[at] == 0xFF:  # any number of fill bytes may stand before a marker
            at += 1
        marker = data[at]
        at += 1
        if marker in SOF_MARKERS:
            height_px, width_px = struct.unpack_from(">HH", data, at + 3)
            return PictureHeader("jpeg", width_px, height_px)
        if marker in (0xD9, 0xDA):
            raise HeaderError("JPEG without a frame header before its data")
        if marker not in BARE_MARKERS:
            (length,) = struct.unpack_from(">H", data, at)
            at += max(2, length)


def _webp(data: bytes) -> PictureHeader:
    kind = data[12:16]
    if kind == b"VP8X":  # 24 bits each, less one
        width, more_width, height, more_height = struct.unpack_from("<HBHB", data, 24)
        return PictureHeader("webp", 1 + (more_width << 16 | width), 1 + (more_height << 16 | height))
    if kind == b"VP8L":
        (bits,) = struct.unpack_from("<I", data, 21)
        return PictureHeader("webp", 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF))
    if kind == b"VP8 ":
        width, height = struct.unpack_from("<HH", data, 26)
        return PictureHeader("webp", width & 0x3FFF, height & 0x3FFF)
    raise HeaderError(f"WebP chunk VP8, VP8L or VP8X expected first, got {kind!r}")
