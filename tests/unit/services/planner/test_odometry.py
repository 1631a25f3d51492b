"""What was commanded says how far the robot went between two frames."""

import pytest

from services.planner.odometry import LONGEST_S, CommandedMotion
from shared.messages.drive import Command

S = 1_000_000_000


@pytest.fixture
def motion():
    moving = CommandedMotion(wheel_radius_m=0.1)
    moving.follow(Command(robot="r1", wheel_speed_radps=5.0))
    moving.until(10 * S)
    return moving


def test_half_a_metre_a_second(motion):
    assert motion.until(10 * S + S // 2) == pytest.approx((0.25, 0.0))


def test_the_direction_is_that_of_the_wheels(motion):
    motion.follow(Command(robot="r1", wheel_speed_radps=5.0, steer_rad=1.5707963))
    assert motion.until(11 * S) == pytest.approx((0.0, 0.5), abs=1e-6)


def test_the_same_frame_gives_the_same_answer(motion):
    assert motion.until(11 * S) == motion.until(11 * S)


def test_in_lockstep_the_step_counts_and_not_the_clock(motion):
    assert motion.until(10 * S + 1, step_s=0.3) == pytest.approx((0.15, 0.0))


def test_a_command_runs_out(motion):
    assert motion.until(1000 * S) == pytest.approx((0.5 * LONGEST_S, 0.0))


def test_nothing_is_known_before_the_first_frame_or_command_or_when_time_jumps_back(motion):
    assert CommandedMotion(0.1).until(5 * S) == (0.0, 0.0)
    assert motion.until(5 * S) == (0.0, 0.0)
