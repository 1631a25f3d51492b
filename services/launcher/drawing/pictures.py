"""Frames and figures as picture files."""

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from shared.messages.sensors import Frame

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 130
"""A figure of 10 inches fills the width of a laptop's screen."""


def picture_of(frame: Frame) -> Image.Image:
    """The frame as an RGB picture."""
    if frame.encoding == "jpeg":
        return Image.open(BytesIO(frame.data)).convert("RGB")
    pixels = np.frombuffer(frame.data, dtype=np.uint8).reshape(frame.height_px, frame.width_px, 3)
    return Image.fromarray(np.ascontiguousarray(pixels[:, :, ::-1]))


def png_bytes(frame: Frame) -> bytes:
    """The frame as a PNG file, as somebody would upload it."""
    buffer = BytesIO()
    picture_of(frame).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()


def save_picture(path: Path, frame: Frame) -> None:
    """Write the frame as PNG."""
    path.write_bytes(png_bytes(frame))


def save_figure(figure: "Figure", path: Path) -> None:
    """Write a drawing as PNG; its folder is made where it is missing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)


def frame_from_file(path: Path, robot: str) -> Frame:
    """Read any picture file as a frame.

    Raises:
        ValueError: not a picture, or not twice as wide as high.
    """
    try:
        picture = Image.open(path).convert("RGB")
    except OSError as error:
        raise ValueError(f"{path} is not a picture that can be read: {error}") from error
    pixels = np.asarray(picture)[:, :, ::-1]
    size = {"width_px": picture.width, "height_px": picture.height}
    return Frame(robot=robot, encoding="bgr8", data=pixels.tobytes(), **size)
