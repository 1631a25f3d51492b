"""Lettering on plates: what people put up to be read. RGB."""

import cv2
import numpy as np
from PIL import Image as Pillow
from PIL import ImageDraw, ImageFont

from simulator.textures.noise import Image, Rgb

TALL_PX = 256
MARGIN = 0.14
"""Of the plate's height, free on every side."""


def plate(text: str, aspect: float, ink: Rgb, ground: Rgb) -> Image:
    """A plate with one line of text, as large as it fits.

    Args:
        text: what is read; empty for a bare plate.
        aspect: width of the plate over its height.
        ink: colour of text and rim, RGB 0..255.
        ground: colour of the rest.

    Returns:
        (height, width, 3) RGB bytes, row 0 at the top; the same bytes for the same arguments.
    """
    size = round(TALL_PX * aspect), TALL_PX
    picture = Pillow.new("RGB", size, ground)
    draw = ImageDraw.Draw(picture)
    draw.rectangle((3, 3, size[0] - 4, size[1] - 4), outline=ink, width=3)
    if text:
        wide, tall = (side - 2 * MARGIN * TALL_PX for side in size)
        left, top, right, low = draw.textbbox(
            (0, 0), text, font=ImageFont.load_default(TALL_PX), stroke_width=5
        )
        share = min(wide / (right - left), tall / (low - top))
        font = ImageFont.load_default(TALL_PX * share)
        draw.text((size[0] / 2, size[1] / 2), text, fill=ink, font=font, anchor="mm", stroke_width=5 * share)
    return np.ascontiguousarray(cv2.GaussianBlur(np.asarray(picture, np.uint8), (0, 0), 1.0))
