"""Perspective views: where they look, which way is up, and the way back."""

import numpy as np
import pytest

from shared.geometry.perspective import PerspectiveView
from shared.geometry.sphere import bearings_from_lonlat

RIGHT_ANGLE = np.pi / 2


def test_centre_pixel_looks_where_the_view_points():
    view = PerspectiveView(256, 256, RIGHT_ANGLE, lon_rad=2.0, lat_rad=0.7, roll_rad=1.1)
    np.testing.assert_allclose(view.lonlat_from_pixels((128.0, 128.0)), (2.0, 0.7), atol=1e-12)


@pytest.mark.parametrize(
    ("pixel", "lonlat_deg"),
    [((0.0, 100.0), (45.0, 0.0)), ((200.0, 100.0), (-45.0, 0.0)), ((100.0, 0.0), (0.0, 45.0))],
)
def test_left_edge_is_left_and_top_edge_is_up(pixel, lonlat_deg):
    view = PerspectiveView(200, 200, RIGHT_ANGLE)
    np.testing.assert_allclose(np.rad2deg(view.lonlat_from_pixels(pixel)), lonlat_deg, atol=1e-9)


def test_round_trip_through_a_rolled_view():
    view = PerspectiveView(320, 240, 1.2, lon_rad=-3.0, lat_rad=-0.9, roll_rad=0.4)
    pixels = np.random.default_rng(1).uniform((0, 0), (320, 240), (500, 2))
    np.testing.assert_allclose(
        view.pixels_from_bearings(view.bearings_from_pixels(pixels)), pixels, atol=1e-9
    )


def test_what_lies_behind_has_no_pixel():
    assert np.isnan(
        PerspectiveView(10, 10, 1.0).pixels_from_bearings(bearings_from_lonlat((np.pi, 0.0)))
    ).all()


@pytest.mark.parametrize("fov", [0.0, np.pi, -1.0])
def test_opening_that_no_plane_holds_is_refused(fov):
    with pytest.raises(ValueError, match="fov_rad"):
        PerspectiveView(10, 10, fov)
