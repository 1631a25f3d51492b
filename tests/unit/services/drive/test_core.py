"""Drive core: hold stops, obstacles come first, the answer carries the question's frame; the velocity law."""

import math

import numpy as np
import pytest
from pydantic import ValidationError

from services.drive.bases.course import BaseLimits
from services.drive.core import Memory, Since, compute_velocity, speed, velocity_gain
from services.drive.limits import DriveLimits, SpeedLimits
from shared.messages.drive import Heading
from shared.messages.sensors import Ranges
from shared.motion.motion import Motion

RANGES_PERIOD_MS = 100
ANGLES = tuple(i * math.tau / 12 for i in range(12))


def ranges(ahead_m=4.0):
    return Ranges(robot="r1", angles_rad=ANGLES, distances_m=(ahead_m, *[4.0] * 11), max_range_m=4.0)


def velocity(heading, ranges, limits=None):
    limits = limits or DriveLimits()
    return compute_velocity(heading, ranges, Since(), Memory(), np.random.default_rng(0), limits)[0]


def test_hold_gives_a_robot_that_stands():
    answer = velocity(Heading(robot="r1", seq=7, action="hold", heading_rad=1.0), ranges())
    assert answer.stands
    assert answer.seq == 7


@pytest.mark.parametrize(("face_rad", "sign"), [(1.0, 1.0), (-2.5, -1.0)])
def test_holding_with_a_direction_to_face_turns_on_the_spot_the_short_way(face_rad, sign):
    answer = velocity(Heading(robot="r1", action="hold", face_rad=face_rad), ranges(ahead_m=0.3))
    assert answer.speed_mps == 0.0
    assert answer.turn_radps * sign == pytest.approx(1.5)


def test_what_the_robot_turned_since_the_frame_is_taken_off_what_is_left_to_turn():
    heading, limits, rng = (
        Heading(robot="r1", action="hold", face_rad=0.3),
        DriveLimits(),
        np.random.default_rng(0),
    )

    def turning(turned_rad):
        since = Since(frame=Motion(turn_rad=turned_rad))
        return compute_velocity(heading, ranges(), since, Memory(), rng, limits)[0]

    assert turning(0.1).turn_radps == pytest.approx(0.4)
    assert turning(0.295).stands
    assert turning(0.4).turn_radps == pytest.approx(-0.2)


def test_a_car_cannot_turn_on_the_spot_and_stands():
    limits = DriveLimits(base=BaseLimits(name="ackermann"))
    assert velocity(Heading(robot="r1", action="hold", face_rad=1.0), ranges(), limits).stands


def test_free_way_follows_the_heading_at_full_speed():
    answer = velocity(Heading(robot="r1", seq=9, epoch=3, heading_rad=1.0), ranges())
    assert (answer.seq, answer.epoch, answer.turn_radps) == (9, 3, 0.0)
    assert (answer.forward_mps, answer.left_mps) == pytest.approx((0.8 * math.cos(1.0), 0.8 * math.sin(1.0)))
    assert not answer.avoiding


def test_obstacle_ahead_changes_the_heading_and_slows():
    answer = velocity(Heading(robot="r1", heading_rad=0.0), ranges(ahead_m=0.45))
    assert answer.avoiding
    assert abs(math.atan2(answer.left_mps, answer.forward_mps)) > math.radians(20.0)


def test_a_slow_robot_needs_less_free_way_for_its_speed_than_a_fast_one():
    def speed_mps(fraction, ahead_m):
        heading = Heading(robot="r1", heading_rad=0.0, speed_fraction=fraction)
        return velocity(heading, ranges(ahead_m)).speed_mps

    assert (speed_mps(1.0, 4.0), speed_mps(0.5, 4.0)) == pytest.approx((0.8, 0.4))
    assert 0.4 < speed_mps(1.0, 1.15) < 0.8
    assert speed_mps(0.5, 1.15) == pytest.approx(0.4)


@pytest.mark.parametrize("delay_s", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("near_m", [0.7, 0.9, 1.2])
def test_speed_is_free_way_over_the_time_to_touch_and_the_delay_with_which_it_is_seen(near_m, delay_s):
    """Speed v = d / (contact_s + delay_s), deploy/ROBOTS.md: as much is near all round, wherever it goes."""
    limits, near = DriveLimits(), ranges().model_copy(update={"distances_m": (near_m,) * 12})
    heading, rng = Heading(robot="r1"), np.random.default_rng(0)
    answer, _ = compute_velocity(heading, near, Since(delay_s=delay_s), Memory(), rng, limits)
    free_m = near_m - limits.passing.disc_m(1.0)
    assert answer.speed_mps == pytest.approx(free_m / (limits.contact_s + delay_s))


def test_commands_outlive_two_readings_and_end_well_within_half_a_second():
    answer = velocity(Heading(robot="r1"), ranges())
    assert 2 * RANGES_PERIOD_MS < answer.ttl_ms <= 250


def test_momentary_rule_depends_only_on_its_inputs():
    limits = DriveLimits(avoidance="momentary")
    heading = Heading(robot="r1", heading_rad=0.2)
    assert velocity(heading, ranges(0.4), limits) == velocity(heading, ranges(0.4), limits)


@pytest.mark.parametrize(("similarity", "gain"), [(0, 1.0), (90, 1.0), (110, 1.0 - 20 / 150), (150, 0.6)])
def test_gain_of_the_thesis(similarity, gain):
    assert velocity_gain(similarity, s_slow=90, s_max=150) == pytest.approx(gain)


def test_outdoor_speed_falls_from_ten_to_six():
    limits = SpeedLimits(max_mps=0.8, min_mps=0.48)
    assert speed(60, 90, 150, 1.0, limits) == 0.8
    assert speed(150, 90, 150, 1.0, limits) == pytest.approx(0.48)


def test_minimum_speed_is_kept_until_the_planner_asks_for_less():
    limits = SpeedLimits(max_mps=0.4, min_mps=0.32)
    assert speed(150, 90, 150, 1.0, limits) == 0.32
    assert speed(150, 90, 150, 0.25, limits) == 0.08


def test_minimum_above_maximum_is_refused():
    with pytest.raises(ValidationError, match="min_mps must be at most max_mps"):
        SpeedLimits(max_mps=0.3, min_mps=0.5)
