"""Remap tables, exercised with OpenCV where it is installed."""

import numpy as np
import pytest

from shared.geometry.perspective import PerspectiveView, rotation_z
from shared.geometry.resampling import pixel_centres, rotation_table, view_table
from shared.geometry.sphere import EquirectGrid

GRID = EquirectGrid(256, 128)


def picture(grid):
    """Smooth function of the bearing, so that a right resampling is known without the picture."""
    return colour(grid.bearings_from_pixels(pixel_centres(grid.width, grid.height)))


def colour(bearings):
    return (bearings @ np.array([0.5, 0.3, 0.2]) + 0.3 * bearings[..., 0] * bearings[..., 1]).astype(
        np.float32
    )


def test_identity_rotation_maps_every_pixel_to_itself():
    table = rotation_table(GRID, GRID, np.eye(3))
    columns, rows = np.meshgrid(np.arange(256), np.arange(128))
    np.testing.assert_allclose(np.mod(table.map_x + 0.5, 256.0), columns + 0.5, atol=1e-3)
    np.testing.assert_allclose(table.map_y, rows, atol=1e-3)
    assert table.inside.all()


def test_turning_left_by_a_quarter_moves_the_picture_a_quarter_to_the_right():
    table = rotation_table(GRID, GRID, rotation_z(np.pi / 2))
    # The turned camera looks at what lay to the left: its centre column shows the old column 64.
    assert table.map_x[64, 128] == pytest.approx(64.0, abs=1e-3)


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


def test_cropped_rows_are_told_and_clamped():
    source = EquirectGrid.cropped(256, 128, 25.0)
    table = rotation_table(GRID, source, np.eye(3))
    assert not table.inside[:18].any()
    assert table.inside[18:110].all()
    assert not table.inside[110:].any()
    assert table.map_y.min() == 0.0
    assert table.map_y.max() == source.height - 1
