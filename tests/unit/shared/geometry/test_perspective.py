"""Perspective views: where they look, which way is up, the way back, and pictures of them by OpenCV."""

import numpy as np
import pytest

from shared.geometry.perspective import PerspectiveView, pixel_centres, view_table
from shared.geometry.sphere import EquirectGrid, bearings_from_lonlat

RIGHT_ANGLE = np.pi / 2
GRID = EquirectGrid(256, 128)


def picture(grid):
    """Smooth function of the bearing, so that a right resampling is known without the picture."""
    return colour(grid.bearings_from_pixels(pixel_centres(grid.width, grid.height)))


def colour(bearings):
    return (bearings @ np.array([0.5, 0.3, 0.2]) + 0.3 * bearings[..., 0] * bearings[..., 1]).astype(
        np.float32
    )


def test_centre_pixel_looks_where_the_view_points():
    view = PerspectiveView(256, 256, RIGHT_ANGLE, lon_rad=2.0, lat_rad=0.7)
    np.testing.assert_allclose(view.lonlat_from_pixels((128.0, 128.0)), (2.0, 0.7), atol=1e-12)


@pytest.mark.parametrize(
    ("pixel", "lonlat_deg"),
    [((0.0, 100.0), (45.0, 0.0)), ((200.0, 100.0), (-45.0, 0.0)), ((100.0, 0.0), (0.0, 45.0))],
)
def test_left_edge_is_left_and_top_edge_is_up(pixel, lonlat_deg):
    view = PerspectiveView(200, 200, RIGHT_ANGLE)
    np.testing.assert_allclose(np.rad2deg(view.lonlat_from_pixels(pixel)), lonlat_deg, atol=1e-9)


def test_round_trip_through_a_tilted_view():
    view = PerspectiveView(320, 240, 1.2, lon_rad=-3.0, lat_rad=-0.9)
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


@pytest.mark.parametrize("lon", [0.0, np.pi, -2.0])
def test_view_across_the_seam_shows_the_right_directions(lon):
    cv2 = pytest.importorskip("cv2")
    view = PerspectiveView(96, 64, 1.5, lon_rad=lon, lat_rad=0.3)
    table = view_table(view, GRID)
    got = cv2.remap(picture(GRID), table.map_x, table.map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)
    np.testing.assert_allclose(got, colour(view.bearings_from_pixels(pixel_centres(96, 64))), atol=2e-3)


def test_view_of_the_pole_does_not_borrow_from_the_other_pole():
    cv2 = pytest.importorskip("cv2")
    view = PerspectiveView(64, 64, 1.0, lat_rad=np.pi / 2)
    table = view_table(view, GRID)
    got = cv2.remap(picture(GRID), table.map_x, table.map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)
    np.testing.assert_allclose(got, colour(view.bearings_from_pixels(pixel_centres(64, 64))), atol=2e-2)


def test_rows_beyond_the_crop_are_clamped_to_the_last_one_kept():
    source = EquirectGrid.cropped(256, 128, 25.0)
    table = view_table(PerspectiveView(64, 128, np.pi * 0.9), source)
    assert table.map_y.min() == 0.0
    assert table.map_y.max() == source.height - 1
