"""An ordinary photo as a goal: bytes of PNG, JPEG or WebP -> upright, with what is known of its camera. Pure.

A picture exactly twice as wide as high is a panorama, one of another shape a photo, unless the sender says
its field of view: then it is a photo. Nearly 2:1 is refused: a panorama that lost some rows would be taken
for a photo of nothing.
"""

import math
from typing import Final

from services.gateway.uploads.picture import decoded, open_still
from services.gateway.uploads.picture_header import PictureHeader
from shared.geometry.photo.exif import NARROWEST_RAD, WIDEST_RAD, read_facts, upright
from shared.geometry.photo.plane import USUAL_RAD
from shared.messages.features import MAX_PHOTO_PX, Photo, PhotoView
from shared.web.problems import ProblemError

MOST_ASPECT: Final = 2.6
"""Longer over shorter side; chosen: the longest phones have 2.2, beyond are strips of panoramas."""
NEARLY_PANORAMA: Final = (1.9, 2.1)
"""Width over height that looks like a panorama gone wrong."""
MIN_SHORT_PX: Final = 200
"""Of the shorter side; chosen: three pixels a degree at 67 degrees, what the pipelines look at."""
FIELD_OF_VIEW_DEG: Final = (math.degrees(NARROWEST_RAD), math.degrees(WIDEST_RAD))
"""What a sender may say."""


def is_photo(header: PictureHeader, *, fov_told: bool) -> bool:
    """Whether a checked picture is to be read as an ordinary photo, not as a panorama.

    Raises:
        ProblemError: a photo that is too small.
    """
    width_px, height_px = header.width_px, header.height_px
    short, long = sorted((width_px, height_px))
    shaped = long <= MOST_ASPECT * short and short > 0
    nearly = height_px > 0 and NEARLY_PANORAMA[0] < width_px / height_px < NEARLY_PANORAMA[1]
    if not shaped or (nearly and not fov_told):
        return False
    if short < MIN_SHORT_PX:
        expected, got = f"a photo of at least {MIN_SHORT_PX} px on each side", f"{width_px} x {height_px} px"
        raise ProblemError(422, "too_small", expected, got, "send a larger picture")
    return True


def decode_photo(data: bytes, header: PictureHeader, field_of_view_deg: float | None) -> Photo:
    """Decode a checked photo, turned as its EXIF says.

    Args:
        data: the whole file.
        header: what `check_file` read of it.
        field_of_view_deg: over the longer side, as the sender says; None for what EXIF says, if anything.

    Raises:
        ProblemError: damaged, or animated.
    """
    image = open_still(data, header)
    facts = read_facts(image)
    share = min(1.0, MAX_PHOTO_PX / max(image.size))
    target = round(image.width * share), round(image.height * share)
    pixels = upright(decoded(image, target), facts.orientation)
    height_px, width_px, _ = pixels.shape
    fov_rad = facts.fov_rad if field_of_view_deg is None else math.radians(field_of_view_deg)
    view = PhotoView(fov_rad=fov_rad or USUAL_RAD, fov_known=fov_rad is not None, aspect=width_px / height_px)
    return Photo(view=view, width_px=width_px, height_px=height_px, data=pixels.tobytes())
