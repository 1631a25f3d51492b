"""What a match says of where its node is."""

import pytest

from services.planner.profiles import DEFAULT, OUTDOOR
from services.planner.similarity import tells_place
from tests.unit.services.planner.travel.seen import match


@pytest.mark.parametrize(
    ("profile", "inliers", "told"), [(DEFAULT, 27, True), (OUTDOOR, 27, False), (OUTDOOR, 250, True)]
)
def test_bearings_that_do_not_change_are_of_this_spot_or_of_what_is_far_away(profile, inliers, told):
    """In a street 27 matches agreed 20 m from the node; at the very spot 300 do."""
    here = match(1, 0.0, 0.0, inliers)
    assert here.status == "no_baseline"
    assert tells_place(here, profile) == told


@pytest.mark.parametrize("profile", [DEFAULT, OUTDOOR])
def test_a_node_in_a_known_direction_is_told_by_few(profile):
    ahead = match(1, 3.0, 0.0, 27)
    assert tells_place(ahead, profile)
    assert not tells_place(ahead.model_copy(update={"heading_std_rad": 0.3}), profile)
