"""What a photo's EXIF says that matters here: which side is up, and its field of view. Pure.

EXIF 2.32 (CIPA DC-008): Orientation, FocalLengthIn35mmFilm, PixelXDimension and PixelYDimension.
"""

import math
import struct
import warnings
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from PIL import ExifTags, Image

FILM_DIAGONAL_MM = math.hypot(36.0, 24.0)
"""Of 35 mm film; focal lengths "in 35 mm film" keep the angle over the diagonal, whatever the aspect."""
NARROWEST_RAD, WIDEST_RAD = math.radians(20.0), math.radians(130.0)
"""Fields of view over the longer side that are believed; beyond are telescopes, fisheyes and mistakes."""
SAME_ASPECT = 0.02
"""Share by which the aspect may differ from what the camera wrote: more, and the photo was cropped since."""


@dataclass(frozen=True)
class PhotoFacts:
    """Field of view over the longer side, None where it is not told; and how the file is turned."""

    fov_rad: float | None = None
    orientation: int = 1


def read_facts(image: Image.Image) -> PhotoFacts:
    """Facts of an opened picture; what EXIF says wrongly counts as not said."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a damaged part what can be read counts
            exif = image.getexif()
            orientation = exif.get(ExifTags.Base.Orientation, 1)
            inner = dict(exif.get_ifd(ExifTags.IFD.Exif))
    except (OSError, ValueError, SyntaxError, LookupError, TypeError, ArithmeticError, struct.error):
        return PhotoFacts()
    known = orientation if orientation in range(1, 9) else 1
    return PhotoFacts(_fov_rad(inner, *image.size), known)


def upright(pixels: npt.NDArray[np.uint8], orientation: int) -> npt.NDArray[np.uint8]:
    """The rows (H, W, 3) as the camera was held, of a file whose EXIF has this orientation."""
    if orientation >= 5:  # rows are columns
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return np.ascontiguousarray(pixels)


def fov_of_film(focal_mm: float, width_px: int, height_px: int) -> float:
    """Field of view over the longer side, radians, of a focal length in 35 mm film."""
    half_mm = 0.5 * FILM_DIAGONAL_MM * max(width_px, height_px) / math.hypot(width_px, height_px)
    return 2.0 * math.atan(half_mm / focal_mm)


def _fov_rad(inner: dict[int, object], width_px: int, height_px: int) -> float | None:
    focal_mm = _number(inner.get(ExifTags.Base.FocalLengthIn35mmFilm))
    if focal_mm is None or focal_mm <= 0.0:
        return None
    sides = [_number(inner.get(tag)) for tag in (ExifTags.Base.ExifImageWidth, ExifTags.Base.ExifImageHeight)]
    told = [side for side in sides if side is not None and side > 0.0]
    if len(told) == 2 and _cropped(max(told) / min(told), width_px, height_px):
        return None
    fov_rad = fov_of_film(focal_mm, width_px, height_px)
    return fov_rad if NARROWEST_RAD <= fov_rad <= WIDEST_RAD else None


def _cropped(aspect: float, width_px: int, height_px: int) -> bool:
    now = max(width_px, height_px) / min(width_px, height_px)
    return abs(now / aspect - 1.0) > SAME_ASPECT


def _number(value: object) -> float | None:
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        return None
    return number if math.isfinite(number) else None
