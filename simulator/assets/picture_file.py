"""Picture files -> textures, decoded with bounds."""

import hashlib
import io
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from simulator.assets.model import AssetError
from simulator.scene.parts import Picture

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".webp")
MOST_SIDE_PX = 4096  # untrusted input: 50 MB when decoded


def picture_from_bytes(data: bytes, name: str) -> Picture:
    """Decode a PNG, JPEG or WebP file.

    Raises:
        AssetError: it is broken or larger than MOST_SIDE_PX.
    """
    try:
        opened = Image.open(io.BytesIO(data), formats=("PNG", "JPEG", "WEBP"))
    except (UnidentifiedImageError, Image.DecompressionBombError, OSError, ValueError, SyntaxError) as error:
        raise AssetError(f"picture {name!r:.80} must be a PNG, JPEG or WebP file: {error!s:.120}") from error
    return picture_from_image(opened, name)


def picture_from_image(image: Any, name: str, cutoff: float | None = None) -> Picture:
    """Decode a picture that Pillow has opened; see `picture_from_bytes`.

    With a `cutoff` there are holes where its opacity, 0 to 1, is below: RGBA bytes, if there are any.
    """
    width, height = image.size
    if max(width, height) > MOST_SIDE_PX:
        raise AssetError(
            f"picture {name!r:.80} must be at most {MOST_SIDE_PX} x {MOST_SIDE_PX} pixels, "
            f"got {width} x {height}; scale it down"
        )
    try:
        pixels = np.array(image.convert("RGB" if cutoff is None else "RGBA"), np.uint8)
    except (OSError, ValueError, SyntaxError, MemoryError, EOFError) as error:
        raise AssetError(f"picture {name!r:.80} is broken: {error!s:.120}; export it again") from error
    if cutoff is None:
        return picture_of(pixels)
    holes = pixels[..., 3] < 255.0 * cutoff
    if not holes.any():
        return picture_of(np.ascontiguousarray(pixels[..., :3]))
    pixels[..., 3] = np.where(holes, 0, 255)
    return picture_of(pixels)


def picture_of(pixels: npt.NDArray[np.uint8]) -> Picture:
    """A texture of (height, width, 3) RGB or (height, width, 4) RGBA bytes, named by its content."""
    digest = hashlib.sha256(repr(pixels.shape).encode() + pixels.tobytes()).hexdigest()
    return Picture(digest[:32], pixels)
