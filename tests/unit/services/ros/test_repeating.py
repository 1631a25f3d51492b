"""When a base is told again, and when it is left to others."""

from services.ros.conversions.twist import STAND, Motion
from services.ros.repeating import LAST_WORDS_S, Repeating

AHEAD = Motion(0.3, 0.0, 0.0)


def test_a_motion_is_told_at_once_and_again_every_period():
    repeating = Repeating()
    told = [k for k in range(20) if repeating.due(AHEAD, 0.02 * k)]
    assert told == [0, 3, 6, 9, 12, 15, 18]


def test_another_motion_is_told_at_once():
    repeating = Repeating()
    assert repeating.due(AHEAD, 0.0)
    assert repeating.due(Motion(0.2, 0.0, 0.0), 0.01)
    assert repeating.due(STAND, 0.02)


def test_a_robot_that_is_to_stand_is_told_for_a_while_and_then_left_to_others():
    repeating = Repeating()
    repeating.due(AHEAD, 0.0)
    told = [0.02 * k for k in range(1, 200) if repeating.due(STAND, 0.02 * k)]
    assert 15 < len(told) < 25
    assert max(told) <= LAST_WORDS_S


def test_nobody_is_told_to_stand_who_was_never_told_to_move():
    repeating = Repeating()
    assert not any(repeating.due(STAND, 0.1 * k) for k in range(50))
