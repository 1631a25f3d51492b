"""A clock of the robot that is off, drifts and jumps; messages that are held up."""

import pytest

from services.ros.conversions.robot_clock import RobotClock


def clock_after(offset_s=100.0, until_s=2.0, delay_s=0.05):
    clock, now_s = RobotClock(), 0.0
    while now_s < until_s:
        assert clock.judge(now_s - delay_s + offset_s, now_s).verdict == "good"
        now_s += 0.1
    return clock


def test_the_fastest_message_says_how_far_the_clocks_are_apart():
    clock = clock_after()
    assert clock.judge(100.0 + 2.0, 2.01).verdict == "good"
    assert clock.offset_s == pytest.approx(100.0 - 0.01)


def test_one_message_that_was_held_up_is_late_and_the_next_is_good():
    clock = clock_after()
    assert clock.judge(101.0, 2.0).verdict == "late"
    assert clock.judge(102.0, 2.05).verdict == "good"


@pytest.mark.parametrize("jump_s", [3600.0, 2.0])
def test_a_clock_that_jumps_ahead_is_named_at_once(jump_s):
    clock = clock_after()
    judged = clock.judge(101.95 + jump_s, 2.0)
    assert (judged.verdict, round(judged.off_s)) == ("jumped", jump_s)
    assert clock.judge(102.05 + jump_s, 2.1).verdict == "good"


@pytest.mark.parametrize("jump_s", [3600.0, 2.0])
def test_a_clock_that_jumps_back_is_named_as_soon_as_several_messages_agree(jump_s):
    clock = clock_after()
    verdicts = [clock.judge(101.95 + 0.1 * k - jump_s, 2.0 + 0.1 * k).verdict for k in range(6)]
    assert verdicts == ["late", "late", "late", "jumped", "good", "good"]


def test_messages_held_up_by_differing_times_are_no_jump():
    clock = clock_after()
    verdicts = {clock.judge(102.0, 2.0 + late_s).verdict for late_s in (0.8, 1.3, 1.8, 2.3, 2.8, 3.3)}
    assert verdicts == {"late"}


def test_clocks_that_drift_by_a_tenth_of_a_second_a_day_stay_good():
    clock, rate = clock_after(), 1.0 + 0.1 / 86_400
    assert {clock.judge(100.0 + s * rate - 0.05, float(s)).verdict for s in range(3, 7_200)} == {"good"}
