"""Regions of a band: where they lie, how large they are, across the seam, and which are left out."""

import math

import numpy as np
import pytest

from services.features.changes.regions import regions

FIRST_ROW = 45
"""Of a band of 90 rows in a picture of 180 x 360: a degree a pixel, 45 degrees to either side."""


def band(*blocks):
    share = np.zeros((90, 360), np.float32)
    for rows, columns, value in blocks:
        share[rows][:, columns] = value
    return share


def test_a_block_is_a_region_in_its_middle_with_its_size():
    (found,) = regions(band((slice(20, 40), slice(80, 100), 0.7)), FIRST_ROW, 0.2, 0.001)
    assert math.degrees(found.bearing_rad) == pytest.approx(90.0)
    assert math.degrees(found.elevation_rad) == pytest.approx(15.0)
    assert (round(math.degrees(found.width_rad)), round(math.degrees(found.height_rad))) == (20, 20)
    size_sr = math.radians(20.0) * (math.sin(math.radians(25.0)) - math.sin(math.radians(5.0)))
    assert found.score == pytest.approx(0.5 * size_sr, rel=1e-3)


def test_a_block_across_the_seam_is_one_region_behind():
    ends = (slice(40, 50), slice(0, 10), 0.7), (slice(40, 50), slice(350, 360), 0.7)
    (found,) = regions(band(*ends), FIRST_ROW, 0.2, 0.001)
    assert abs(found.bearing_rad) == pytest.approx(math.pi)
    assert math.degrees(found.width_rad) == pytest.approx(20.0)


def test_small_and_weak_ones_are_left_out_and_the_rest_come_by_significance():
    small, weak = (slice(40, 42), slice(200, 202), 0.9), (slice(40, 60), slice(250, 270), 0.15)
    less, more = (slice(40, 50), slice(100, 110), 0.5), (slice(40, 50), slice(20, 30), 0.9)
    found = regions(band(small, weak, less, more), FIRST_ROW, 0.2, 0.004)
    assert [round(math.degrees(each.bearing_rad)) for each in found] == [155, 75]


def test_the_box_holds_the_whole_region_wherever_most_of_it_differs():
    much, little = (slice(40, 50), slice(100, 110), 0.9), (slice(40, 50), slice(110, 140), 0.3)
    (found,) = regions(band(much, little), FIRST_ROW, 0.2, 0.001)
    assert math.degrees(found.bearing_rad) == pytest.approx(180.0 - 120.0)
    assert math.degrees(found.width_rad) == pytest.approx(40.0)
