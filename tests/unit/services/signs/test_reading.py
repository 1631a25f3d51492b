"""Signs in a panorama: where on the sphere, and which readings count. A red plate is read as text."""

import math

import numpy as np
import pytest

from services.signs.reading import Reading, signs_in, unequivocal, view_at, views
from services.signs.recognition import Line
from shared.geometry.sphere import EquirectGrid, bearings_from_lonlat

WIDTH, HEIGHT = 512, 256
GRID = EquirectGrid.cropped(WIDTH, HEIGHT, 0.0)
HALF_DEG = (5.0, 3.0)


def panorama(*plates):
    """Grey, with a red plate of 10 x 6 degrees round each (longitude, latitude), degrees; row by row."""
    lonlat = np.degrees(
        GRID.lonlat_from_pixels(np.stack(np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5), -1))
    )
    picture = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
    for lon, lat in plates:
        away = np.abs((lonlat[..., 0] - lon + 180.0) % 360.0 - 180.0), np.abs(lonlat[..., 1] - lat)
        picture[(away[0] < HALF_DEG[0]) & (away[1] < HALF_DEG[1])] = (0, 0, 255)
    return picture


def reader(*answers, confidence=0.99):
    """Reads the red of a picture as one line, with each of some texts in turn and then always the last."""
    told = list(answers)

    def read(picture):
        rows, columns = np.nonzero((picture[..., 2] > 170) & (picture[..., 0] < 60))
        if not len(rows):
            return []
        u, v = (columns.min(), columns.max() + 1), (rows.min(), rows.max() + 1)
        corners = np.array([(u[0], v[0]), (u[1], v[0]), (u[1], v[1]), (u[0], v[1])], float)
        return [Line(told.pop(0) if len(told) > 1 else told[0], confidence, corners)]

    return read


@pytest.mark.parametrize("lon", [0.0, 37.0, -100.0, 178.0, -179.0])
@pytest.mark.parametrize("lat", [5.0, 30.0])
def test_a_sign_is_found_at_its_bearing_also_across_the_seam(lon, lat):
    picture = panorama((lon, lat))
    (found,) = signs_in(picture, picture, reader("214"), 0.9)
    assert found.text == "214"
    assert abs((math.degrees(found.longitude_rad) - lon + 180.0) % 360.0 - 180.0) < 0.7
    assert math.degrees(found.height_rad) == pytest.approx(2 * HALF_DEG[1], abs=1.2)


def test_a_reading_that_another_frame_does_not_confirm_does_not_count():
    picture = panorama((10.0, 20.0))
    assert signs_in(picture, panorama(), reader("214"), 0.9) == []
    assert len(signs_in(picture, panorama((24.0, 20.0)), reader("214"), 0.9)) == 1


def test_a_text_that_is_read_otherwise_in_a_larger_picture_does_not_count():
    picture = panorama((60.0, 20.0))
    assert signs_in(picture, picture, reader("214", "211"), 0.9) == []


@pytest.mark.parametrize(
    ("text", "confidence"), [("214", 0.8), ("2", 0.99), ("--- .", 0.99), ("\u202e\x07", 0.99)]
)
def test_what_is_doubtful_or_no_text_does_not_count(text, confidence):
    picture = panorama((60.0, 20.0))
    assert signs_in(picture, picture, reader(text, confidence=confidence), 0.9) == []


def test_text_from_outside_is_cleaned_and_bounded():
    picture = panorama((60.0, 20.0))
    (found,) = signs_in(picture, picture, reader("\x1b[31m 2\u202e14 \n" + "9" * 100), 0.9)
    assert found.text == "[31m 214 " + "9" * 55


def test_views_go_all_round_and_what_a_border_cuts_off_is_not_read():
    borders = [view.lon_rad + view.fov_rad / 2.0 for view in views(WIDTH)]
    picture = panorama((math.degrees(borders[2]), 20.0))
    assert len(signs_in(picture, picture, reader("214"), 0.9)) == 1  # the view beside shows all of it
    alone = [view for view in views(WIDTH) if view.lon_rad == views(WIDTH)[2].lon_rad]
    from services.signs.reading import readings

    assert list(readings(picture, alone[0], reader("21"), 0.9)) == []


def test_what_is_read_in_two_ways_is_left_out_and_what_is_read_twice_is_one():
    def at(text, lon_rad, confidence=0.99):
        x, y, z = bearings_from_lonlat((lon_rad, 0.3)).tolist()
        return Reading(text, confidence, (x, y, z), 0.1)

    assert [one.text for one in unequivocal([at("214", 0.0), at("214", 0.05), at("216", 1.0)])] == [
        "214",
        "216",
    ]
    assert unequivocal([at("214", 0.0), at("21", 0.06)]) == []
    assert unequivocal([at("room 214", 0.0, 0.98), at("ROOM 214", 0.06)])[0].confidence == 0.99


def test_the_second_look_is_larger():
    x, y, z = bearings_from_lonlat((1.0, 0.2)).tolist()
    view = view_at(Reading("214", 1.0, (x, y, z), 0.1), 1024)
    assert view.focal_px > 1.5 * views(1024)[0].focal_px
    assert view.lonlat_from_pixels((view.width / 2, view.height / 2)) == pytest.approx((1.0, 0.2))
