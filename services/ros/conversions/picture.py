"""sensor_msgs/CompressedImage and Image to frame.v1: equirectangular, exactly 2:1. Pure.

A JPEG whose middle looks ahead already goes through as it came; everything else becomes bgr8.
"""

import io
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from services.ros.conversions.header import ConversionError

Picture = npt.NDArray[np.uint8]

CHANNELS = {"bgr8": (0, 1, 2), "rgb8": (2, 1, 0), "bgra8": (0, 1, 2), "rgba8": (2, 1, 0), "mono8": (0, 0, 0)}
"""sensor_msgs/image_encodings: where blue, green and red stand in a pixel."""
WIDTH = {"bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4, "mono8": 1}
MOST_WIDTH_PX = 16_384
"""Widest frame of the bus (shared/messages/sensors.py)."""
FORMATS = ("JPEG", "PNG")
"""What image_transport's compressed topics carry."""


@dataclass(frozen=True)
class Panorama:
    """Content of a frame."""

    encoding: Literal["bgr8", "jpeg"]
    width_px: int
    height_px: int
    data: bytes


def panorama_of(message: Any, kind: str, ahead_px_share: float) -> Panorama:
    """Convert a picture.

    Args:
        message: sensor_msgs/CompressedImage or Image.
        kind: which of them.
        ahead_px_share: where straight ahead is, as a share of the width; 0.5 is the middle column.

    Raises:
        ConversionError: no picture, not 2:1, or an encoding nobody expects.
    """
    if kind.endswith("/CompressedImage"):
        data = bytes(message.data)
        opened = _opened(data)
        _check_shape(*opened.size)
        if opened.format == "JPEG" and ahead_px_share == 0.5:
            return Panorama("jpeg", *opened.size, data)
        bgr = _decoded(opened)
    else:
        bgr = _raw(message)
    turned = np.roll(bgr, round((0.5 - ahead_px_share) * bgr.shape[1]), axis=1)
    return Panorama("bgr8", bgr.shape[1], bgr.shape[0], np.ascontiguousarray(turned).tobytes())


def _opened(data: bytes) -> Image.Image:
    """Header of a compressed picture; its pixels are not touched yet."""
    try:
        return Image.open(io.BytesIO(data), formats=FORMATS)
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, ValueError) as error:
        raise ConversionError(
            f"a JPEG or PNG expected, {len(data)} bytes beginning with {data[:8]!r} are none"
        ) from error


def _decoded(opened: Image.Image) -> Picture:
    try:
        return np.asarray(opened.convert("RGB"))[:, :, ::-1]
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise ConversionError(f"a damaged picture: {str(error)[:100]}") from error


def _raw(message: Any) -> Picture:
    """Pixels of an uncompressed picture, which may have bytes at the end of each row."""
    encoding, width, height = message.encoding, message.width, message.height
    _check_shape(width, height)
    if encoding not in CHANNELS:
        raise ConversionError(f"encoding {encoding[:40]!r}: one of {', '.join(CHANNELS)} expected")
    pixel_bytes = WIDTH[encoding]
    if message.step < width * pixel_bytes or len(message.data) != message.step * height:
        raise ConversionError(
            f"{encoding} of {width} x {height} in rows of {message.step} bytes needs "
            f"{message.step * height} bytes, at least {width * pixel_bytes} a row; got {len(message.data)}"
        )
    rows = np.asarray(message.data, dtype=np.uint8).reshape(height, message.step)
    pixels = rows[:, : width * pixel_bytes].reshape(height, width, pixel_bytes)
    return pixels[:, :, list(CHANNELS[encoding])]


def _check_shape(width_px: int, height_px: int) -> None:
    if width_px != 2 * height_px or not 2 <= width_px <= MOST_WIDTH_PX:
        raise ConversionError(
            f"an equirectangular picture, exactly 2:1 and at most {MOST_WIDTH_PX} wide, expected; "
            f"got {width_px} x {height_px}"
        )
