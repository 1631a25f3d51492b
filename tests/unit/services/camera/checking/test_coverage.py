"""What of the sphere is seen, and whether edges meet."""

import math

import numpy as np
import pytest

from services.camera.checking.coverage import coverage_of, ends, joins, jump
from tests.painted_room import room

WHOLE = room(np.eye(3), 512)


def degrees(coverage):
    return math.degrees(coverage.lowest_rad), math.degrees(coverage.highest_rad)


def test_a_panorama_covers_the_sphere():
    coverage = coverage_of([WHOLE])
    assert degrees(coverage) == (-90.0, 90.0)
    assert coverage.blank_share < 0.001


def test_black_bars_above_and_below_are_no_picture():
    barred = WHOLE.copy()
    barred[:64] = barred[-43:] = 9  # of 256 rows: 45 degrees above, 30 below
    assert degrees(coverage_of([barred])) == pytest.approx((-60.0, 45.0), abs=0.4)
    assert 0.0 < coverage_of([barred]).blank_share < 0.2


def test_what_is_dark_once_is_not_blank():
    dark = np.zeros_like(WHOLE)
    assert coverage_of([dark, WHOLE]).blank_share < 0.001
    assert degrees(coverage_of([dark])) == (0.0, 0.0)
    assert coverage_of([dark]).blank_share == pytest.approx(1.0)


def test_edges_that_meet_change_as_much_as_the_picture_beside_them():
    assert jump(WHOLE, ends(WHOLE)) < 2.0


def test_edges_of_a_picture_that_is_no_whole_turn_do_not_meet():
    part = np.repeat(WHOLE[:, 100:356], 2, axis=1)
    assert jump(part, ends(part)) > 3.0


def test_the_seam_of_two_lenses_is_where_one_takes_over_from_the_other():
    sides = np.zeros(WHOLE.shape[:2], dtype=bool)
    sides[:, 128:384] = True
    seam = joins(sides)
    assert sorted(set(np.nonzero(seam)[1])) == [127, 383]
    shifted = WHOLE.copy()
    shifted[:, 128:384] = np.roll(WHOLE, 17, axis=0)[:, 128:384]
    assert jump(WHOLE, seam) < 2.0
    assert jump(shifted, seam) > 3.0
    assert jump(WHOLE, np.zeros_like(seam)) == 1.0
