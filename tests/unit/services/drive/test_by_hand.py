"""A person drives: one at a time, for as long as they say so, and never into anything."""

import math

import numpy as np
import pytest

from services.drive.bases.course import BaseLimits, Twist
from services.drive.by_hand import Hand, by_hand
from services.drive.limits import DriveLimits
from shared.geometry.clearance import Obstacles
from shared.messages.drive import Manual

OPEN = Obstacles(np.empty((0, 2)))


def wish(seq=1, who="Ada", **more):
    return Manual(robot="r1", seq=seq, who=who, **more)


def wall(x_m):
    return Obstacles(np.array([[x_m, y] for y in np.linspace(-1.0, 1.0, 41)]))


@pytest.fixture
def refused():
    return []


@pytest.fixture
def hand(refused):
    return Hand(lambda kind, why: refused.append((kind, why)))


def test_a_wish_holds_for_its_ttl(hand):
    hand.hear(wish(forward_mps=0.3, ttl_ms=400), 10.0)
    assert hand.wish(10.39).forward_mps == 0.3
    assert hand.wish(10.41) is None


def test_whoever_drives_keeps_the_robot_until_they_let_go(hand, refused):
    hand.hear(wish(forward_mps=0.3), 10.0)
    hand.hear(wish(9, "Bob", forward_mps=-0.3), 10.1)
    assert hand.wish(10.2).who == "Ada"
    assert refused == [("taken", "Bob wishes to drive, and Ada does")]
    hand.hear(wish(2, action="release"), 10.2)
    assert hand.wish(10.2) is None
    hand.hear(wish(10, "Bob", forward_mps=-0.3), 10.3)
    assert hand.wish(10.3).who == "Bob"


def test_whoever_is_silent_has_let_go(hand):
    hand.hear(wish(ttl_ms=400), 10.0)
    hand.hear(wish(1, "Bob"), 10.5)
    assert hand.wish(10.5).who == "Bob"


def test_a_wish_that_was_overtaken_does_not_count(hand, refused):
    hand.hear(wish(5, forward_mps=0.0), 10.0)
    hand.hear(wish(4, forward_mps=0.5), 10.1)
    assert hand.wish(10.1).forward_mps == 0.0
    assert refused[0][0] == "late"


def test_an_open_way_is_driven_as_wished_up_to_the_limits():
    assert by_hand(wish(forward_mps=0.3, left_mps=-0.1, turn_radps=0.5), OPEN, DriveLimits()) == Twist(
        0.3, -0.1, 0.5
    )
    fast = by_hand(wish(forward_mps=3.0, left_mps=4.0), OPEN, DriveLimits())
    assert math.hypot(fast.forward_mps, fast.left_mps) == pytest.approx(DriveLimits().speeds.max_mps)
    assert fast.left_mps / fast.forward_mps == pytest.approx(4.0 / 3.0)
    assert by_hand(wish(turn_radps=-9.0), OPEN, DriveLimits()).turn_radps == -BaseLimits().turn_radps


@pytest.mark.parametrize("wished", [{"forward_mps": 0.5}, {"forward_mps": 0.5, "left_mps": 0.05}])
def test_it_slows_before_a_wall_stands_at_it_and_may_back_off(wished):
    limits = DriveLimits()
    speeds = [by_hand(wish(**wished), wall(x_m), limits).forward_mps for x_m in (2.0, 0.6, 0.45, 0.28, 0.26)]
    assert speeds[0] == 0.5
    assert sorted(speeds, reverse=True) == speeds
    assert 0.0 < speeds[2] < 0.2
    assert speeds[-1] == pytest.approx(0.0, abs=0.01)
    assert by_hand(wish(forward_mps=-0.5), wall(0.26), limits).forward_mps == -0.5


@pytest.mark.parametrize("forward_mps", [0.4, -0.4])
def test_a_bend_into_a_wall_is_slowed_and_one_away_from_it_is_not(forward_mps):
    aside = Obstacles(np.array([[x, 0.45] for x in np.linspace(-1.0, 1.0, 41)]))
    turn = math.copysign(1.0, forward_mps)
    into = by_hand(wish(forward_mps=forward_mps, turn_radps=turn), aside, DriveLimits())
    away = by_hand(wish(forward_mps=forward_mps, turn_radps=-turn), aside, DriveLimits())
    assert abs(into.forward_mps) < abs(forward_mps) == abs(away.forward_mps)
    assert into.turn_radps / into.forward_mps == pytest.approx(turn / forward_mps)


@pytest.mark.parametrize(("base", "turn_radps"), [("differential", 1.0), ("ackermann", 0.5)])
def test_what_a_base_cannot_do_is_left_out(base, turn_radps):
    limits = DriveLimits(base=BaseLimits(name=base, radius_m=0.4))
    done = by_hand(wish(forward_mps=0.2, left_mps=0.3, turn_radps=1.0), OPEN, limits)
    assert done == Twist(0.2, 0.0, turn_radps)
    spun = by_hand(wish(turn_radps=1.0), OPEN, limits)
    assert spun.turn_radps == (0.0 if base == "ackermann" else 1.0)
