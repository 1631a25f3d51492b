"""A heading that flips is waited out; one that turns slowly, or beside its target, is followed at once."""

import math

from services.planner.travel.following.steady_heading import PATIENCE, SteadyHeading


def test_single_flips_are_ignored():
    steady = SteadyHeading()
    seen = [0.1, 0.1 + math.pi, 0.12, -3.0, 0.15]
    assert [steady.follow(4, h, close=False) for h in seen] == [0.1, 0.1, 0.12, 0.12, 0.15]


def test_a_flip_that_stays_is_believed():
    steady = SteadyHeading()
    steady.follow(4, 0.0, close=False)
    headings = [steady.follow(4, 3.0, close=False) for _ in range(PATIENCE + 1)]
    assert headings == [0.0] * PATIENCE + [3.0]


def test_close_to_the_target_and_for_another_target_it_turns_at_once():
    steady = SteadyHeading()
    steady.follow(4, 0.0, close=False)
    assert steady.follow(4, 3.0, close=True) == 3.0
    assert steady.follow(5, 0.0, close=False) == 0.0


def test_slow_turns_are_followed():
    steady = SteadyHeading()
    for degrees in range(0, 360, 40):
        heading = math.remainder(math.radians(degrees), math.tau)
        assert steady.follow(4, heading, close=False) == heading
