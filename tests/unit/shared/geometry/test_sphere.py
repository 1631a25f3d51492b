"""Angles and the equirectangular grid: hand-computed values, round trips, crop, resize, seam and poles."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shared.geometry.sphere import (
    EquirectGrid,
    angle_between_rad,
    bearings_from_lonlat,
    lonlat_from_bearings,
    wrap_rad,
)

FULL = EquirectGrid(2048, 1024)


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [(0.0, 0.0), (np.pi, -np.pi), (-np.pi, -np.pi), (1.5 * np.pi, -0.5 * np.pi), (-1.5 * np.pi, 0.5 * np.pi)],
)
def test_wrap_of_known_angles(angle, wrapped):
    assert wrap_rad(angle) == pytest.approx(wrapped, abs=1e-12)


@settings(deadline=None)
@given(st.floats(-1e3, 1e3))
def test_wrapped_angle_is_half_open_and_points_the_same_way(angle):
    wrapped = float(wrap_rad(angle))
    assert -np.pi <= wrapped < np.pi
    assert np.cos(wrapped) == pytest.approx(np.cos(angle), abs=1e-9)
    assert np.sin(wrapped) == pytest.approx(np.sin(angle), abs=1e-9)


def test_just_below_minus_pi_does_not_become_plus_pi():
    assert float(wrap_rad(np.nextafter(-np.pi, -10.0))) < np.pi
    assert float(wrap_rad(-np.pi - 1e-17)) == -np.pi


@pytest.mark.parametrize(
    ("pixel", "bearing"),
    [
        pytest.param((1024.0, 512.0), (1.0, 0.0, 0.0), id="centre looks ahead"),
        pytest.param((512.0, 512.0), (0.0, 1.0, 0.0), id="a quarter from the left looks left"),
        pytest.param((1536.0, 512.0), (0.0, -1.0, 0.0), id="three quarters looks right"),
        pytest.param((0.0, 512.0), (-1.0, 0.0, 0.0), id="column 0 looks back"),
        pytest.param((1024.0, 0.0), (0.0, 0.0, 1.0), id="top looks up"),
        pytest.param((1024.0, 1024.0), (0.0, 0.0, -1.0), id="bottom looks down"),
        pytest.param((1024.0, 256.0), (np.sqrt(0.5), 0.0, np.sqrt(0.5)), id="45 degrees up"),
    ],
)
def test_bearing_of_known_pixel(pixel, bearing):
    np.testing.assert_allclose(FULL.bearings_from_pixels(pixel), bearing, atol=1e-12)


def test_first_pixel_centre_is_half_a_pixel_from_the_seam():
    lon, lat = FULL.lonlat_from_pixels((0.5, 0.5))
    assert lon == pytest.approx(np.pi - np.pi / 2048)
    assert lat == pytest.approx(np.pi / 2 - np.pi / 2048)


@pytest.mark.parametrize(("rows", "kept", "cut"), [(1024, 740, 142), (400, 288, 56)])
def test_crop_of_25_degrees_keeps_the_rows_of_the_thesis(rows, kept, cut):
    grid = EquirectGrid.cropped(2 * rows, rows, 25.0)
    assert (grid.height, grid.crop_top, grid.crop_bottom) == (kept, cut, cut)
    assert grid.row_slice == slice(cut, cut + kept)


def test_crop_shifts_rows_and_restores_angles():
    grid = EquirectGrid.cropped(2048, 1024, 25.0)
    np.testing.assert_allclose(
        grid.lonlat_from_pixels((700.0, 100.0)), FULL.lonlat_from_pixels((700.0, 242.0)), atol=1e-15
    )


def test_resize_after_crop_keeps_every_direction():
    grid = EquirectGrid.cropped(2048, 1024, 25.0)
    small = grid.resized(800, 400)
    assert (small.width, small.height) == (800, 400)
    point = np.array([300.0, 555.0])
    np.testing.assert_allclose(
        small.lonlat_from_pixels(point * [800 / 2048, 400 / 740]), grid.lonlat_from_pixels(point), atol=1e-12
    )


@pytest.mark.parametrize(
    "grid",
    [FULL, EquirectGrid.cropped(800, 400, 25.0), EquirectGrid.cropped(2048, 1024, 25.0).resized(801, 399)],
)
def test_round_trip_returns_the_same_pixel_whatever_the_bearing_length(grid):
    rng = np.random.default_rng(7)
    pixels = rng.uniform((0.0, 0.5), (grid.width, grid.height - 0.5), size=(5000, 2))
    points = grid.bearings_from_pixels(pixels) * rng.uniform(0.1, 50.0, (5000, 1))
    np.testing.assert_allclose(grid.pixels_from_bearings(points), pixels, atol=1e-6)


@settings(deadline=None)
@given(st.floats(-np.pi, np.pi, exclude_max=True), st.floats(-1.57, 1.57))
def test_round_trip_of_angles_is_exact_to_a_millionth_of_a_degree(lon, lat):
    back = lonlat_from_bearings(bearings_from_lonlat((lon, lat)))
    assert abs(np.angle(np.exp(1j * (back[0] - lon)))) < np.deg2rad(1e-6)
    assert abs(back[1] - lat) < np.deg2rad(1e-6)


def test_straight_back_is_column_zero_and_longitude_minus_pi():
    back = np.array([[-1.0, 0.0, 0.0], [-1.0, -0.0, 0.0], [-1.0, -1e-18, 0.0]])
    np.testing.assert_array_equal(FULL.pixels_from_bearings(back)[:, 0], 0.0)
    np.testing.assert_array_equal(lonlat_from_bearings(back)[:, 0], -np.pi)


def test_longitude_a_rounding_error_beyond_the_seam_stays_in_the_image():
    assert FULL.pixels_from_lonlat((np.pi + 1e-15, 0.0))[0] < 2048.0


def test_columns_wrap():
    np.testing.assert_allclose(
        FULL.lonlat_from_pixels((2048.0 + 10.0, 300.0)), FULL.lonlat_from_pixels((10.0, 300.0)), atol=1e-12
    )


def test_poles_keep_their_latitude_whatever_the_longitude():
    np.testing.assert_allclose(
        lonlat_from_bearings([(0.0, 0.0, 2.0), (1e-9, 0.0, -1.0)])[:, 1], [np.pi / 2, -np.pi / 2]
    )


def test_angle_between_resolves_what_arccos_cannot():
    a, b = bearings_from_lonlat((0.3, 0.2)), bearings_from_lonlat((0.3, 0.2 + 1e-9))
    assert float(angle_between_rad(a, b)) == pytest.approx(1e-9, rel=1e-6)


def test_wrong_shape_is_named():
    with pytest.raises(ValueError, match=r"pixels must have shape \(\.\.\., 2\), got \(3,\)"):
        FULL.lonlat_from_pixels(np.zeros(3))


@pytest.mark.parametrize("crop", [90.0, -1.0])
def test_impossible_crop_is_refused(crop):
    with pytest.raises(ValueError, match="crop must leave"):
        EquirectGrid.cropped(800, 400, crop)
