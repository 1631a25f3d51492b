"""The small picture that goes with a frame's features: made, and read again. Pure."""

import cv2
import numpy as np

from services.features.pipeline.interfaces import Image
from shared.jpeg import BadPictureError, jpeg_size
from shared.messages.features import MAX_THUMBNAIL_BYTES

MOST_PIXELS = 2_000_000
"""Of a thumbnail; chosen: four times those of the widest in the settings. A few bytes may announce more."""


def thumbnail(picture: Image, width_px: int, quality: int) -> bytes:
    """JPEG of (H, 2H, 3) BGR, width_px columns; empty when it would not fit into a message."""
    small = cv2.resize(picture, (width_px, width_px // 2), interpolation=cv2.INTER_AREA)
    packed, data = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes() if packed and data.size <= MAX_THUMBNAIL_BYTES else b""


def from_thumbnail(jpeg: bytes) -> Image | None:
    """(H, W, 3) BGR of a thumbnail; None of one that is empty, damaged or too large."""
    try:
        width_px, height_px = jpeg_size(jpeg)
    except BadPictureError:
        return None
    if width_px * height_px > MOST_PIXELS:
        return None
    picture = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    return None if picture is None else np.asarray(picture, np.uint8)
