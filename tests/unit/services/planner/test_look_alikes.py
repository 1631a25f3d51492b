"""What the visits of earlier missions say of how often rooms look alike in everything."""

import math

import pytest

from services.planner.look_alikes import FITS_LEVELS, LookAlikes


def test_the_risk_grows_with_places_that_nobody_saw_and_with_equal_ones_and_shrinks_with_those_told_apart():
    new = LookAlikes()
    assert new.risk(0) == 0.0
    assert new.risk(1) < new.risk(7)
    assert new.with_more([20.0] * 5, 0).risk(3) < new.risk(3) < new.with_more([], 1).risk(3)


def test_rooms_that_nothing_told_apart_count_more_than_what_other_buildings_say():
    """Half of the rooms seen were equal: of one more that is as likely as not."""
    assert LookAlikes([20.0] * 40, 40).risk(1) == pytest.approx(0.25, abs=0.03)


def test_what_other_buildings_say_counts_where_the_place_fits_only():
    new = LookAlikes()
    assert new.risk(1, fits=False) == pytest.approx(0.25)
    assert new.risk(1) < 0.05


@pytest.mark.parametrize(
    ("told", "most"), [([], FITS_LEVELS), ([27.0, math.inf, 31.0], FITS_LEVELS), ([27.0, 9.0], 4.5)]
)
def test_a_place_fits_that_differs_as_little_as_right_ones_and_half_as_much_as_any_other(told, most):
    known = LookAlikes(told)
    assert known.fits(most)
    assert not known.fits(most + 0.1)


def test_what_the_mission_under_way_found_out_is_learnt_at_its_end_only():
    known = LookAlikes([20.0])
    assert known.with_more([30.0], 1) == LookAlikes([20.0, 30.0], 1)
    assert known == LookAlikes([20.0])
