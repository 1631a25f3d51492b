"""The direction back to the place left turns slowly; a jump gives a look-alike view away."""

import math

from services.planner.mapping.departure import Departure
from services.planner.profiles import DEFAULT
from shared.messages.matching import NodeMatch


def seen(heading_rad, confidence=0.9, inliers=60):
    return NodeMatch(
        node_id=4, raw_matches=300, inliers=inliers, status="ok", confidence=confidence,
        heading_rad=math.remainder(heading_rad, math.tau), yaw_rad=0.0,
    )  # fmt: skip


def test_a_direction_back_that_turns_slowly_is_followed():
    departure = Departure(4, 0, 0.0)
    for degrees in (180, 170, 150, 130, 110, 90):
        assert departure.follows(seen(math.radians(degrees)), DEFAULT)


def test_a_jump_is_not_followed_and_not_remembered():
    departure = Departure(4, 0, 0.0)
    assert departure.follows(seen(math.pi), DEFAULT)
    assert not departure.follows(seen(0.1), DEFAULT)
    assert not departure.follows(seen(0.1), DEFAULT)
    assert departure.follows(seen(3.0), DEFAULT)


def test_after_the_first_frame_less_is_a_jump():
    departure = Departure(4, 0, 0.0)
    assert departure.follows(seen(math.pi - 1.0), DEFAULT)
    assert not departure.follows(seen(math.pi - 1.5), DEFAULT)


def test_the_first_direction_must_lie_behind_the_robot():
    assert not Departure(4, 0, 1.0).follows(seen(1.0), DEFAULT)
    assert Departure(4, 0, 1.0).follows(seen(1.0 + math.pi), DEFAULT)


def test_an_unsure_direction_says_nothing():
    departure = Departure(4, 0, 0.0)
    assert departure.follows(seen(0.0, confidence=0.1), DEFAULT)
    assert departure.back_rad is None
    assert departure.follows(None, DEFAULT)


def test_passing_the_place_on_the_way_out_is_no_jump():
    departure = Departure(4, 0, 0.0)
    assert departure.follows(seen(0.0, inliers=250), DEFAULT)
    assert departure.follows(seen(math.pi), DEFAULT)
