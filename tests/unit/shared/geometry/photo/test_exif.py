"""What EXIF says of a photo: which side is up, and how wide it sees."""

import io
import math

import numpy as np
import pytest
from PIL import ExifTags, Image, ImageOps

from shared.geometry.photo.exif import PhotoFacts, fov_of_film, read_facts, upright


def photo(size: tuple[int, int] = (40, 30), orientation: object = 1, **inner: object) -> Image.Image:
    pixels = np.random.default_rng(3).integers(0, 255, (size[1], size[0], 3), dtype=np.uint8)
    image, out = Image.fromarray(pixels), io.BytesIO()
    exif = image.getexif()
    exif[ExifTags.Base.Orientation] = orientation
    for name, value in inner.items():
        exif.get_ifd(ExifTags.IFD.Exif)[ExifTags.Base[name]] = value
    image.save(out, "PNG", exif=exif)
    return Image.open(out)


def test_26_mm_of_film_see_67_degrees_over_the_longer_side_of_a_4_to_3_photo() -> None:
    # The diagonal 43.27 mm has a long side of 4/5 of it, 34.61 mm: 2 atan(17.31 / 26) = 67.3 degrees.
    facts = read_facts(photo(FocalLengthIn35mmFilm=26))
    assert facts.fov_rad is not None
    assert math.degrees(facts.fov_rad) == pytest.approx(67.3, abs=0.05)
    assert fov_of_film(26.0, 30, 40) == pytest.approx(facts.fov_rad)


@pytest.mark.parametrize("focal_mm", [0, 3, 600])
def test_a_focal_length_that_no_phone_has_is_not_believed(focal_mm: int) -> None:
    assert read_facts(photo(FocalLengthIn35mmFilm=focal_mm)).fov_rad is None


def test_a_photo_cropped_since_has_no_known_field_of_view() -> None:
    cropped = photo((40, 40), FocalLengthIn35mmFilm=26, ExifImageWidth=4000, ExifImageHeight=3000)
    turned = photo((30, 40), FocalLengthIn35mmFilm=26, ExifImageWidth=4000, ExifImageHeight=3000)
    assert read_facts(cropped).fov_rad is None
    assert read_facts(turned).fov_rad is not None


@pytest.mark.parametrize("orientation", range(1, 9))
def test_every_orientation_is_turned_upright_as_pillow_does(orientation: int) -> None:
    image = photo(orientation=orientation)
    facts = read_facts(image)
    expected = np.asarray(ImageOps.exif_transpose(image))
    assert np.array_equal(upright(np.asarray(image), facts.orientation), expected)


def test_without_exif_or_with_nonsense_nothing_is_known() -> None:
    assert read_facts(Image.new("RGB", (40, 30))) == PhotoFacts()
    assert read_facts(photo(orientation=77)) == PhotoFacts()
    image = Image.new("RGB", (40, 30))
    image.info["exif"] = b"Exif\x00\x00MM\x00*\x00\x00\x00\x08\xff\xff" + b"\x07" * 60
    assert read_facts(image).fov_rad is None
