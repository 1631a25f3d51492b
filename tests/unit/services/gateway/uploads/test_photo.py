"""Ordinary photos as uploads: told from panoramas, turned upright, their field of view read or told."""

import io
import math

import numpy as np
import pytest
from PIL import ExifTags, Image

from services.gateway.uploads.photo import decode_photo, is_photo
from services.gateway.uploads.picture import check_file
from services.gateway.uploads.picture_header import PictureHeader
from shared.geometry.photo.plane import USUAL_RAD
from shared.web.problems import ProblemError


def saved(width, height, orientation=1, film_mm=None, kind="JPEG"):
    """A photo whose upper left quarter is red, as stored."""
    pixels = np.full((height, width, 3), 90, np.uint8)
    pixels[: height // 2, : width // 2] = (250, 0, 0)
    image, out = Image.fromarray(pixels), io.BytesIO()
    exif = image.getexif()
    exif[ExifTags.Base.Orientation] = orientation
    if film_mm is not None:
        exif.get_ifd(ExifTags.IFD.Exif)[ExifTags.Base.FocalLengthIn35mmFilm] = film_mm
    image.save(out, kind, exif=exif, quality=95)
    return out.getvalue()


def photo(data, told_deg=None):
    return decode_photo(data, check_file(data, "image/jpeg"), told_deg)


@pytest.mark.parametrize(
    ("size", "told", "expected"),
    [
        ((4000, 3000), False, True),
        ((3000, 4000), False, True),
        ((1600, 720), False, True),
        ((2048, 1024), False, False),
        ((2048, 1024), True, True),
        ((2048, 1030), False, False),
        ((2048, 1030), True, True),
        ((3000, 1000), True, False),
        ((0, 0), True, False),
    ],
)
def test_shape_tells_photos_from_panoramas_unless_a_field_of_view_is_told(size, told, expected):
    assert is_photo(PictureHeader("jpeg", *size), fov_told=told) is expected


def test_a_photo_too_small_to_show_a_place_is_refused():
    with pytest.raises(ProblemError) as caught:
        is_photo(PictureHeader("png", 260, 199), fov_told=False)
    assert (caught.value.status_code, caught.value.code) == (422, "too_small")


def test_a_large_photo_is_shrunk_and_says_by_exif_how_wide_it_sees():
    found = photo(saved(3200, 2400, film_mm=26))
    assert (found.width_px, found.height_px) == (1600, 1200)
    assert found.view.fov_known
    assert math.degrees(found.view.fov_rad) == pytest.approx(67.3, abs=0.05)
    assert found.view.aspect == pytest.approx(4 / 3)


def test_a_turned_photo_is_turned_upright():
    found = photo(saved(400, 300, orientation=6))  # the stored left side is the top: red comes right
    pixels = np.frombuffer(found.data, np.uint8).reshape(found.height_px, found.width_px, 3)
    assert (found.width_px, found.height_px) == (300, 400)
    assert pixels[50, 250, 2] > 200 > pixels[50, 50, 2]
    assert found.view.aspect == pytest.approx(0.75)


def test_what_is_told_counts_more_than_exif_and_nothing_told_is_unknown():
    told = photo(saved(400, 300, film_mm=26), 80.0).view
    assert (told.fov_rad, told.fov_known) == (pytest.approx(math.radians(80.0)), True)
    unknown = photo(saved(400, 300)).view
    assert (unknown.fov_rad, unknown.fov_known) == (pytest.approx(USUAL_RAD), False)


def test_a_damaged_photo_is_refused():
    data = saved(800, 600)
    with pytest.raises(ProblemError) as caught:
        photo(data[: len(data) // 2])
    assert (caught.value.status_code, caught.value.code) == (422, "damaged")
