"""A goal picture: bytes of PNG, JPEG or WebP -> an equirectangular bgr8 frame. Pure.

The one conversion, whatever the file holds:
    size        the stored raster decides; EXIF rotation is ignored, like everywhere in this project.
    grey        repeated in all three channels; 16-bit samples keep their high byte (scaled, not clipped).
    palette     looked up. Transparency: composed over black.
    CMYK        converted without a colour profile. Colour profiles are ignored.
    animation   refused: which picture is the goal would be a guess.
    large       shrunk by area averaging to 2048 x 1024; small ones stay.
"""

import io
import math
import warnings
from typing import Final

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from services.gateway.uploads.picture_header import HeaderError, PictureHeader, read_header
from shared.web.problems import ProblemError

MAX_PIXELS: Final = {"jpeg": 64_000_000, "png": 34_000_000, "webp": 20_000_000}
"""A JPEG is shrunk while it is decoded; PNG is decoded whole, at 4 bytes a pixel, and WebP at 16."""
MAX_SCANS: Final = 100
"""Of a JPEG. Progressive ones have ten or so; each is a pass over the picture, an empty one a dozen bytes."""
BAND_ROWS: Final = 64
"""Rows of the result converted at a time: a large picture shall not be there in several modes at once."""
MIN_WIDTH_PX: Final = 128
"""Chosen: 3 degrees a pixel; less shows no place."""
MAX_WIDTH_PX: Final = 2048
"""Twice the width of the simulated camera's pictures, with which the pipelines' figures were measured."""
PILLOW_FORMATS: Final = {"png": ("PNG",), "jpeg": ("JPEG",), "webp": ("WEBP",)}

Bgr = npt.NDArray[np.uint8]


def check_header(data: bytes, declared_type: str) -> PictureHeader:
    """Check format and size of a panorama from the first bytes.

    Args:
        data: the whole file.
        declared_type: content type it was sent with.

    Raises:
        ProblemError: empty, another format, not the declared one, or a size a panorama cannot have.
    """
    header = check_file(data, declared_type)
    check_panorama(header)
    return header


def check_file(data: bytes, declared_type: str) -> PictureHeader:
    """Check format and number of pixels of any picture from the first bytes.

    Raises:
        ProblemError: empty, another format, not the declared one, or more than can be decoded.
    """
    if not data:
        raise ProblemError(422, "empty", "a picture", "0 bytes", "send the file's content")
    try:
        header = read_header(data)
    except HeaderError as error:
        expected, next_step = "a PNG, JPEG or WebP picture", "convert it to one of the three"
        raise ProblemError(415, "not_a_picture", expected, str(error), next_step) from None
    if declared_type != f"image/{header.format}":
        expected, got = f"content type image/{header.format} for these bytes", declared_type[:80]
        next_step = "send the content type that fits the file"
        raise ProblemError(415, "type_mismatch", expected, got or "no content type", next_step)
    _check_pixels(header)
    if header.format == "jpeg" and (scans := data.count(b"\xff\xda")) > MAX_SCANS:
        expected, next_step = f"a JPEG of at most {MAX_SCANS} scans", "save it as a baseline JPEG"
        raise ProblemError(422, "too_many_scans", expected, f"{scans}", next_step)
    return header


def decode_bgr(data: bytes, header: PictureHeader) -> Bgr:
    """Decode a checked picture.

    Returns:
        (H, W, 3) uint8, blue first, W = 2 H, W <= 2048.

    Raises:
        ProblemError: damaged, animated, or not of the size its header claims.
    """
    target = (min(header.width_px, MAX_WIDTH_PX), min(header.height_px, MAX_WIDTH_PX // 2))
    return decoded(open_still(data, header), target)


def decoded(image: Image.Image, target: tuple[int, int]) -> Bgr:
    """Decode an opened picture to (H, W, 3) uint8, blue first, shrunk to `target` (W, H) by area averaging.

    Raises:
        ProblemError: damaged.
    """
    try:
        image.draft("RGB", target)  # JPEG only: decodes at 1/2, 1/4 or 1/8 of the size
        image.load()
    except (OSError, ValueError, SyntaxError, EOFError, IndexError, KeyError, MemoryError) as error:
        raise _damaged(error) from None
    return np.concatenate([_band(image, target, row) for row in range(0, target[1], BAND_ROWS)])


def _check_pixels(header: PictureHeader) -> None:
    most, got = MAX_PIXELS[header.format], f"{header.width_px} x {header.height_px} px"
    if header.width_px * header.height_px > most:
        expected = f"at most {most // 1_000_000} megapixels as {header.format.upper()}"
        next_step = "send a smaller picture or, up to 64 megapixels, a JPEG"
        raise ProblemError(413, "too_many_pixels", expected, got, next_step)


def check_panorama(header: PictureHeader) -> None:
    """Check the size of a panorama.

    Raises:
        ProblemError: not twice as wide as high, or too small.
    """
    width_px, height_px = header.width_px, header.height_px
    got = f"{width_px} x {height_px} px"
    if width_px != 2 * height_px:
        expected = "an equirectangular panorama, exactly twice as wide as high"
        next_step = "export the whole sphere (360 x 180 degrees)"
        raise ProblemError(422, "not_two_to_one", expected, got, next_step)
    if width_px < MIN_WIDTH_PX:
        expected = f"at least {MIN_WIDTH_PX} x {MIN_WIDTH_PX // 2} px"
        raise ProblemError(422, "too_small", expected, got, "send a larger picture")


def open_still(data: bytes, header: PictureHeader) -> Image.Image:
    """Open a checked file of one picture.

    Raises:
        ProblemError: damaged, animated, or not of the size its header claims.
    """
    image = _open(data, header)
    pictures = getattr(image, "n_frames", 1)
    if pictures > 1 and image.format != "MPO":  # MPO: the first picture is the main one
        raise ProblemError(422, "animated", "one still picture", f"{pictures} pictures", "send one of them")
    return image


def _open(data: bytes, header: PictureHeader) -> Image.Image:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # oddities in metadata that do not matter to the pixels
            image = Image.open(io.BytesIO(data), formats=PILLOW_FORMATS[header.format])
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise _damaged(error) from None
    if image.size != (header.width_px, header.height_px):
        raise _damaged(ValueError(f"header says {header[1:]}, decoder says {image.size}"))
    return image


def _band(image: Image.Image, target: tuple[int, int], row: int) -> Bgr:
    """Rows `row` to `row + BAND_ROWS` of the result, averaged over the rows of `image` that they cover."""
    width, height = target
    rows = min(BAND_ROWS, height - row)
    top, bottom = row * image.height / height, (row + rows) * image.height / height
    first = math.floor(top)
    rgb = _as_rgb(image.crop((0, first, image.width, min(image.height, math.ceil(bottom)))))
    if image.size != target:
        box = (0.0, top - first, float(image.width), min(bottom - first, float(rgb.height)))
        rgb = rgb.resize((width, rows), Image.Resampling.BOX, box)
    return np.ascontiguousarray(np.asarray(rgb, dtype=np.uint8)[:, :, ::-1])


def _as_rgb(image: Image.Image) -> Image.Image:
    if image.mode.startswith("I"):  # 16-bit grey: Pillow's own conversion clips at 255
        high = np.asarray(image).astype(np.uint32) >> 8
        image = Image.fromarray(high.clip(0, 255).astype(np.uint8))
    if "transparency" in image.info or image.mode in ("LA", "PA", "RGBA", "La", "RGBa"):
        rgba = image.convert("RGBA")
        black = Image.new("RGBA", rgba.size, (0, 0, 0, 255))
        image = Image.alpha_composite(black, rgba)
    return image.convert("RGB")


def _damaged(error: Exception) -> ProblemError:
    expected, next_step = "a picture that decodes to its end", "send the file again or re-save it"
    return ProblemError(422, "damaged", expected, f"a damaged file ({str(error)[:120]})", next_step)
