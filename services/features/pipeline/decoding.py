"""Frame message -> picture, distrusting every byte. Pure."""

import cv2
import numpy as np

from services.features.pipeline.interfaces import Image
from shared.messages.sensors import Frame

MAX_PIXELS = 64_000_000
"""Largest picture decoded; chosen: more than 360-degree cameras give, 192 MB of colours."""
REDUCED = {2: cv2.IMREAD_REDUCED_COLOR_2, 4: cv2.IMREAD_REDUCED_COLOR_4, 8: cv2.IMREAD_REDUCED_COLOR_8}


class BadPictureError(ValueError):
    """A frame that holds no usable picture; the text says why."""


def decode_picture(frame: Frame, enough_px: int | None = None) -> Image:
    """Decode a frame to (H, 2H, 3) BGR.

    Args:
        frame: the message.
        enough_px: columns that suffice; a JPEG much wider is decoded at a half, quarter or eighth of its size
            (measured for 2048 columns: 5 ms instead of 13). None for its full size.

    Raises:
        BadPictureError: too large, not a JPEG, cut short, or of another size than announced.
    """
    pixels = frame.width_px * frame.height_px
    if pixels > MAX_PIXELS:
        raise BadPictureError(
            f"picture must have at most {MAX_PIXELS} pixels, got {frame.width_px} x {frame.height_px}"
        )
    if frame.encoding == "bgr8":
        flat = np.frombuffer(frame.data, dtype=np.uint8)
        return flat.reshape(frame.height_px, frame.width_px, 3)
    width, height = jpeg_size(frame.data)
    if (width, height) != (frame.width_px, frame.height_px):
        raise BadPictureError(
            f"frame announces {frame.width_px} x {frame.height_px}, its JPEG is {width} x {height}"
        )
    if b"\xff\xd9" not in frame.data[-64:]:
        raise BadPictureError("JPEG is cut short: no end marker, send it again")
    divisor = max((d for d in REDUCED if enough_px is not None and width // d >= enough_px), default=1)
    flags = REDUCED.get(divisor, cv2.IMREAD_COLOR) | cv2.IMREAD_IGNORE_ORIENTATION
    try:
        picture = cv2.imdecode(np.frombuffer(frame.data, dtype=np.uint8), flags)
    except cv2.error as error:
        raise BadPictureError(f"JPEG cannot be decoded: {str(error)[:120]}") from error
    if picture is None or picture.shape[:2] != (-(-height // divisor), -(-width // divisor)):
        raise BadPictureError("JPEG cannot be decoded: its data are damaged")
    return np.asarray(picture, dtype=np.uint8)


def jpeg_size(data: bytes) -> tuple[int, int]:
    """Width and height from a JPEG's frame header (ITU-T T.81, B.2.2), without decoding it.

    Raises:
        BadPictureError: there is no such header.
    """
    if data[:2] != b"\xff\xd8":
        raise BadPictureError("not a JPEG: it must start with FF D8")
    position = 2
    while position + 9 <= len(data):
        if data[position] != 0xFF:
            break
        marker = data[position + 1]
        if (
            marker == 0xFF or marker == 0x01 or 0xD0 <= marker <= 0xD7
        ):  # fill bytes and markers without a length
            position += 1 if marker == 0xFF else 2
            continue
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height = int.from_bytes(data[position + 5 : position + 7])
            width = int.from_bytes(data[position + 7 : position + 9])
            return width, height
        position += 2 + int.from_bytes(data[position + 2 : position + 4])
    raise BadPictureError("not a JPEG: no frame header with its size")
