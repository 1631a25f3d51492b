"""Frame message -> picture, distrusting every byte. Pure."""

import cv2
import numpy as np
import numpy.typing as npt

from shared.jpeg import BadPictureError, jpeg_size, require_whole
from shared.messages.sensors import Frame

Image = npt.NDArray[np.uint8]

MAX_PIXELS = 64_000_000
"""Largest picture decoded; chosen: more than 360-degree cameras give, 192 MB of colours."""
REDUCED = {2: cv2.IMREAD_REDUCED_COLOR_2, 4: cv2.IMREAD_REDUCED_COLOR_4, 8: cv2.IMREAD_REDUCED_COLOR_8}


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
    require_whole(frame.data)
    divisor = max((d for d in REDUCED if enough_px is not None and width // d >= enough_px), default=1)
    flags = REDUCED.get(divisor, cv2.IMREAD_COLOR) | cv2.IMREAD_IGNORE_ORIENTATION
    try:
        picture = cv2.imdecode(np.frombuffer(frame.data, dtype=np.uint8), flags)
    except cv2.error as error:
        raise BadPictureError(f"JPEG cannot be decoded: {str(error)[:120]}") from error
    if picture is None or picture.shape[:2] != (-(-height // divisor), -(-width // divisor)):
        raise BadPictureError("JPEG cannot be decoded: its data are damaged")
    return np.asarray(picture, dtype=np.uint8)
