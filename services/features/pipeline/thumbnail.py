"""A small JPEG of a frame, for people. Pure."""

import cv2

from services.features.pipeline.interfaces import Image

MAX_BYTES = 200_000


def make_thumbnail(picture: Image, width_px: int, quality: int) -> bytes:
    """Shrink (H, 2H, 3) BGR to width_px columns and pack it; empty when it would not fit into a message."""
    small = cv2.resize(picture, (width_px, width_px // 2), interpolation=cv2.INTER_AREA)
    packed, data = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes() if packed and data.size <= MAX_BYTES else b""
