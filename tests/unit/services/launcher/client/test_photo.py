"""A photo from a file: upright, shrunk, with its field of view as EXIF says or as told; else refused."""

import math

import numpy as np
import pytest
from PIL import ExifTags, Image

from services.launcher.client import photo as client_photo
from services.launcher.client.failure import ExperimentError
from services.launcher.client.photo import locate_photo, photo_from_file
from shared.geometry.photo.plane import USUAL_RAD
from shared.messages.features import ExtractPhotoRequest
from shared.messages.maps import MapReply
from shared.messages.matching import MatchReply
from shared.queries import RefusedError
from tests import bare_places


@pytest.fixture
def saved(tmp_path):
    """Writes a photo whose upper left quarter is red, as stored."""

    def save(width, height, orientation=1, film_mm=None):
        pixels = np.full((height, width, 3), 90, np.uint8)
        pixels[: height // 2, : width // 2] = (250, 0, 0)
        exif = Image.Exif()
        exif[ExifTags.Base.Orientation] = orientation
        if film_mm is not None:
            exif.get_ifd(ExifTags.IFD.Exif)[ExifTags.Base.FocalLengthIn35mmFilm] = film_mm
        path = tmp_path / "phone.jpg"
        Image.fromarray(pixels).save(path, exif=exif, quality=95)
        return path

    return save


def test_a_turned_photo_is_turned_upright_and_shrunk(saved):
    photo = photo_from_file(saved(3200, 2400, orientation=6), None)  # stored red, upper left, comes right
    assert (photo.width_px, photo.height_px) == (1200, 1600)
    pixels = np.frombuffer(photo.data, np.uint8).reshape(photo.height_px, photo.width_px, 3)
    assert pixels[200, 1000, 2] > 200 > pixels[200, 200, 2]
    assert photo.view.aspect == pytest.approx(0.75)


@pytest.mark.parametrize(
    ("film_mm", "told_deg", "expected_deg"), [(26, None, 67.3), (26, 80.0, 80.0), (None, 80.0, 80.0)]
)
def test_what_is_told_counts_more_than_exif(saved, film_mm, told_deg, expected_deg):
    view = photo_from_file(saved(800, 600, film_mm=film_mm), told_deg).view
    assert view.fov_known
    assert math.degrees(view.fov_rad) == pytest.approx(expected_deg, abs=0.05)


def test_of_a_photo_that_says_nothing_the_field_of_view_is_not_known(saved):
    view = photo_from_file(saved(800, 600), None).view
    assert (view.fov_known, view.fov_rad) == (False, USUAL_RAD)


def test_a_photo_too_small_to_show_a_place_is_refused(saved):
    with pytest.raises(ExperimentError, match="has 400 x 199 px, a photo needs 200 on each side"):
        photo_from_file(saved(400, 199), None)


def test_half_a_photo_is_refused_by_name(saved):
    path = saved(800, 600)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(ExperimentError, match=r"phone\.jpg is not a picture that can be read"):
        photo_from_file(path, None)


class Looking:
    """A feature service that looks at pictures before it answers the last of so many questions."""

    def __init__(self, busy: int, code: str = "busy") -> None:
        self.asked, self._busy, self._code = 0, busy, code

    def ask(self, _query, request, _timeout_s, **_names):
        if isinstance(request, ExtractPhotoRequest):
            return bare_places.FEATURES.model_copy(update={"photo": request.photo.view})
        self.asked += 1
        if self.asked <= self._busy:
            raise RefusedError("9 pictures have to be looked at: ask again", self._code)
        return MatchReply(map=request.map)


def test_a_photo_is_asked_about_again_while_pictures_are_looked_at(saved):
    photo, known = photo_from_file(saved(800, 600), 70.0), MapReply(map="flat", revision=1)
    bus = Looking(busy=3)
    assert locate_photo(bus, "r1", known, photo).answer.verdict == "not_found"
    assert bus.asked == 4


@pytest.mark.parametrize(("code", "patience_s"), [("missing", 60.0), ("busy", 0.0)])
def test_another_refusal_or_one_for_too_long_is_the_answer(saved, monkeypatch, code, patience_s):
    monkeypatch.setattr(client_photo, "LOOKING_S", patience_s)
    photo, bus = photo_from_file(saved(800, 600), 70.0), Looking(busy=3, code=code)
    with pytest.raises(RefusedError, match="looked at"):
        locate_photo(bus, "r1", MapReply(map="flat", revision=1), photo)
    assert bus.asked == 1
