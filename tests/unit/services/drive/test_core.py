"""Drive core: hold stops, obstacles come first, the answer carries the question's frame; the velocity law."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from services.drive.core import DriveLimits, WheelLimits, compute_command, velocity_gain, wheel_speed
from services.drive.passing import Passing
from shared.messages.drive import Heading
from shared.messages.sensors import Ranges

RANGES_PERIOD_MS = 100
ANGLES = tuple(i * math.tau / 12 for i in range(12))


def ranges(ahead_m=4.0):
    return Ranges(robot="r1", angles_rad=ANGLES, distances_m=(ahead_m, *[4.0] * 11), max_range_m=4.0)


def command(heading, ranges, limits=None):
    limits = limits or DriveLimits()
    return compute_command(heading, ranges, Passing(), np.random.default_rng(0), limits)[0]


def test_hold_gives_still_wheels():
    answer = command(Heading(robot="r1", seq=7, action="hold", heading_rad=1.0), ranges())
    assert answer.wheel_speed_radps == 0.0
    assert answer.seq == 7


def test_free_way_follows_the_heading_at_full_speed():
    answer = command(Heading(robot="r1", seq=9, epoch=3, heading_rad=1.0), ranges())
    assert (answer.seq, answer.epoch, answer.steer_rad, answer.wheel_speed_radps) == (9, 3, 1.0, 10.0)
    assert not answer.avoiding


def test_obstacle_ahead_changes_the_heading_and_slows():
    answer = command(Heading(robot="r1", heading_rad=0.0), ranges(ahead_m=0.45))
    assert answer.avoiding
    assert abs(answer.steer_rad) > math.radians(20.0)


def test_a_slow_robot_needs_less_free_way_for_its_speed_than_a_fast_one():
    def speed(fraction, ahead_m):
        heading = Heading(robot="r1", heading_rad=0.0, speed_fraction=fraction)
        return command(heading, ranges(ahead_m)).wheel_speed_radps

    assert (speed(1.0, 4.0), speed(0.5, 4.0)) == (10.0, 5.0)
    assert 5.0 < speed(1.0, 1.15) < 10.0
    assert speed(0.5, 1.15) == 5.0


def test_commands_outlive_two_readings_and_end_well_within_half_a_second():
    answer = command(Heading(robot="r1"), ranges())
    assert 2 * RANGES_PERIOD_MS < answer.ttl_ms <= 250


def test_momentary_rule_depends_only_on_its_inputs():
    limits = DriveLimits(avoidance="momentary")
    heading = Heading(robot="r1", heading_rad=0.2)
    assert command(heading, ranges(0.4), limits) == command(heading, ranges(0.4), limits)


@pytest.mark.parametrize(("similarity", "gain"), [(0, 1.0), (90, 1.0), (110, 1.0 - 20 / 150), (150, 0.6)])
def test_gain_of_the_thesis(similarity, gain):
    assert velocity_gain(similarity, s_slow=90, s_max=150) == pytest.approx(gain)


def test_outdoor_speed_falls_from_ten_to_six():
    limits = WheelLimits(max_radps=10.0, min_radps=6.0)
    assert wheel_speed(60, 90, 150, 1.0, limits) == 10.0
    assert wheel_speed(150, 90, 150, 1.0, limits) == pytest.approx(6.0)


def test_minimum_speed_is_kept_until_the_planner_asks_for_less():
    limits = WheelLimits(max_radps=5.0, min_radps=4.0)
    assert wheel_speed(150, 90, 150, 1.0, limits) == 4.0
    assert wheel_speed(150, 90, 150, 0.25, limits) == 1.0


def test_minimum_above_maximum_is_refused():
    with pytest.raises(ValidationError, match="min_radps must be at most max_radps"):
        WheelLimits(max_radps=3.0, min_radps=5.0)
