"""Regions against truth: near a change is right, elsewhere false; what is out of sight is not asked for."""

import math

import numpy as np

from experiments.changes.judging import Truth
from shared.messages.inspections import Region


def region(bearing_deg, elevation_deg=0.0, wide_deg=5.0, high_deg=5.0):
    bearing_rad, elevation_rad = math.radians(bearing_deg), math.radians(elevation_deg)
    size = {"width_rad": math.radians(wide_deg), "height_rad": math.radians(high_deg)}
    return Region(bearing_rad=bearing_rad, elevation_rad=elevation_rad, **size)


def labels():
    """A degree a pixel: 1 ahead, 2 across the seam, a speck of 3, a shadow to the left."""
    marked = np.zeros((180, 360), np.uint8)
    marked[80:100, 170:190] = 1
    marked[80:100, :6] = marked[80:100, -6:] = 2
    marked[90, 300] = 3
    marked[80:100, 80:100] = 255
    return marked


def test_a_change_is_reported_by_a_region_in_it_or_up_to_five_degrees_beside_it():
    truth = Truth(labels(), 3)
    for bearing_deg, hit in ((0.0, True), (14.0, True), (-14.0, True), (17.0, False)):
        verdict = truth.judge([region(bearing_deg)])
        assert verdict.by_number == {1: hit, 2: False}
        assert len(verdict.false) == (not hit)


def test_a_change_across_the_seam_is_one():
    for bearing_deg in (179.0, -179.0, 171.0, -171.0):
        assert Truth(labels(), 3).judge([region(bearing_deg)]).by_number[2]


def test_a_box_reports_what_it_holds_most_of():
    marked = np.zeros((180, 360), np.uint8)
    marked[80:100, 170:190], marked[80:100, 200:210] = 1, 2
    truth = Truth(marked, 2)
    for wide_deg, held in ((58.0, True), (42.0, False)):
        verdict = truth.judge([region(0.0, 0.0, wide_deg, 20.0)])
        assert verdict.by_number == {1: True, 2: held}, wide_deg
        assert verdict.false == ()


def test_a_box_round_everything_reports_only_what_it_lies_on():
    verdict = Truth(labels(), 2).judge([region(0.0, 0.0, 359.0, 80.0)])
    assert verdict.by_number == {1: True, 2: False}


def test_a_box_across_the_seam_holds_both_ends():
    marked = np.zeros((180, 360), np.uint8)
    marked[80:100, :6] = marked[80:100, -6:] = 1
    marked[80:100, 20:26] = 2
    verdict = Truth(marked, 2).judge([region(170.0, 0.0, 38.0, 20.0)])
    assert verdict.by_number == {1: True, 2: True}


def test_shadows_are_no_change_and_no_error():
    verdict = Truth(labels(), 3).judge([region(90.0)])
    assert not any(verdict.by_number.values())
    assert verdict.false == ()


def test_a_speck_is_not_asked_for_but_may_be_reported():
    verdict = Truth(labels(), 3).judge([region(-120.0), region(0.0, 60.0)])
    assert 3 not in verdict.by_number
    assert [round(math.degrees(each.elevation_rad)) for each in verdict.false] == [60]


def test_solid_angles_are_those_of_the_sphere():
    assert math.isclose(
        Truth(labels(), 1).judge([]).sizes_sr[1],
        math.radians(20.0) * 2 * math.sin(math.radians(10)),
        rel_tol=1e-3,
    )
