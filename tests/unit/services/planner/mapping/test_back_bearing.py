"""The bearing back to the node left turns slowly; a jump gives an aliased view away."""

import math

from services.planner.mapping.back_bearing import BackBearing
from services.planner.profiles import DEFAULT
from shared.messages.matching import NodeMatch


def seen(heading_rad, confidence=0.9, inliers=60):
    return NodeMatch(
        node_id=4, raw_matches=300, inliers=inliers, status="ok", confidence=confidence,
        heading_rad=math.remainder(heading_rad, math.tau), yaw_rad=0.0,
    )  # fmt: skip


def test_a_direction_back_that_turns_slowly_is_followed():
    back = BackBearing()
    for degrees in (180, 170, 150, 130, 110, 90):
        assert back.follows(seen(math.radians(degrees)), 0.0, DEFAULT)


def test_a_jump_is_not_followed_and_not_remembered():
    back = BackBearing()
    assert back.follows(seen(math.pi), 0.0, DEFAULT)
    assert not back.follows(seen(0.1), 0.0, DEFAULT)
    assert not back.follows(seen(0.1), 0.0, DEFAULT)
    assert back.follows(seen(3.0), 0.0, DEFAULT)


def test_after_the_first_frame_less_is_a_jump():
    back = BackBearing()
    assert back.follows(seen(math.pi - 1.0), 0.0, DEFAULT)
    assert not back.follows(seen(math.pi - 1.5), 0.0, DEFAULT)


def test_the_first_direction_must_lie_behind_the_robot():
    assert not BackBearing().follows(seen(1.0), 1.0, DEFAULT)
    assert BackBearing().follows(seen(1.0 + math.pi), 1.0, DEFAULT)


def test_an_unsure_direction_says_nothing():
    back = BackBearing()
    assert back.follows(seen(0.0, confidence=0.1), 0.0, DEFAULT)
    assert back.back_rad is None
    assert back.follows(None, 0.0, DEFAULT)


def test_passing_the_place_on_the_way_out_is_no_jump():
    back = BackBearing()
    assert back.follows(seen(0.0, inliers=250), 0.0, DEFAULT)
    assert back.follows(seen(math.pi), 0.0, DEFAULT)
