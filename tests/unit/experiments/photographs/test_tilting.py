"""A picture re-rendered with a tilted camera shows things where geometry says."""

import math

import cv2
import numpy as np
import pytest

from experiments.photographs.tilting import pitch_roll, rotation_of, tilt
from shared.geometry.sphere import EquirectGrid, angle_between_rad, bearings_from_lonlat

GRID = EquirectGrid(1024, 512)


def spot_at(lon_deg, lat_deg):
    """A black picture with a white spot, 2 degrees wide."""
    centres = np.stack(np.meshgrid(np.arange(1024) + 0.5, np.arange(512) + 0.5), axis=-1)
    towards = bearings_from_lonlat(np.radians([lon_deg, lat_deg]))
    near = angle_between_rad(GRID.bearings_from_pixels(centres), towards) < math.radians(1.0)
    return np.repeat(np.where(near, 255, 0).astype(np.uint8)[..., None], 3, axis=2)


def bearing_of_spot(picture):
    weights = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype(float)
    centres = np.stack(np.meshgrid(np.arange(1024) + 0.5, np.arange(512) + 0.5), axis=-1)
    solid = np.cos(GRID.lonlat_from_pixels(centres)[..., 1])
    return np.einsum("ij,ijk->k", weights * solid, GRID.bearings_from_pixels(centres))


@pytest.mark.parametrize("lonlat_deg", [(0.0, 0.0), (90.0, 20.0), (179.9, -10.0), (-60.0, 45.0)])
@pytest.mark.parametrize("tilt_deg", [(10.0, 0.0), (0.0, -7.0), (3.0, 4.0)])
def test_a_spot_moves_to_where_the_turned_camera_sees_it(lonlat_deg, tilt_deg):
    pitch_rad, roll_rad = np.radians(tilt_deg)
    seen = bearing_of_spot(tilt(spot_at(*lonlat_deg), pitch_rad, roll_rad))
    expected = rotation_of(pitch_rad, roll_rad).T @ bearings_from_lonlat(np.radians(lonlat_deg))
    assert angle_between_rad(seen, expected) < math.radians(0.15)  # half a pixel


def test_nose_down_lifts_what_is_ahead_and_left_up_lowers_what_is_left():
    ahead, left = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    assert rotation_of(0.1, 0.0).T @ ahead == pytest.approx([math.cos(0.1), 0.0, math.sin(0.1)])
    assert rotation_of(0.0, 0.1).T @ left == pytest.approx([0.0, math.cos(0.1), -math.sin(0.1)])


def test_a_tilt_about_an_axis_leaves_what_lies_on_it():
    pitch_rad, roll_rad = pitch_roll(0.2, 0.7)
    axis = np.array([math.cos(0.7), math.sin(0.7), 0.0])
    assert rotation_of(pitch_rad, roll_rad) @ axis == pytest.approx(axis)
    assert math.hypot(pitch_rad, roll_rad) == pytest.approx(0.2)


def test_no_tilt_changes_nothing(rng):
    picture = rng.integers(0, 255, (64, 128, 3), dtype=np.uint8)
    assert np.array_equal(tilt(picture, 0.0, 0.0), picture)
