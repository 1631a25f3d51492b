"""What was told or measured says how far the robot went between two frames, and since the newest."""

import math

import pytest

from services.planner.odometry import FrameMotion
from shared.messages.body import Odometry
from shared.messages.drive import Velocity
from shared.messages.features import Features
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION

S = 1_000_000_000


def ranges(stamp_ns, distance_m=1.0):
    return Ranges(
        robot="r1",
        stamp_ns=stamp_ns,
        angles_rad=tuple(k * math.tau / 12 for k in range(12)),
        distances_m=(distance_m,) * 12,
        max_range_m=4.0,
    )


def velocity(at_ns):
    return Velocity(robot="r1", at_ns=at_ns, forward_mps=0.5, ttl_ms=500)


def seen(motion, stamp_ns, now_s=0.0):
    features = Features.model_construct(stamp_ns=stamp_ns)
    return motion.observe(features, now_s)


@pytest.fixture
def motion():
    moving = FrameMotion()
    moving.sensed(ranges(10 * S), 0.0)
    seen(moving, 10 * S)
    moving.told(velocity(10 * S))
    return moving


def test_half_a_metre_a_second(motion):
    motion.sensed(ranges(10 * S + S // 2), 0.5)
    moved = seen(motion, 10 * S + S // 2, 0.5).moved
    assert (moved.x_m, moved.y_m, moved.turn_rad) == pytest.approx((0.25, 0.0, 0.0))


def test_a_velocity_runs_out(motion):
    motion.sensed(ranges(12 * S), 2.0)
    assert seen(motion, 12 * S, 2.0).moved.x_m == pytest.approx(0.25)


def test_a_frame_asked_for_again_counts_no_way_twice(motion):
    motion.sensed(ranges(10 * S + S // 2), 0.5)
    first, again = (seen(motion, 10 * S + S // 2, 0.5) for _ in range(2))
    assert first.moved != NO_MOTION
    assert again.moved == NO_MOTION
    assert (again.ranges, again.since) == (first.ranges, first.since)


def test_odometry_counts_before_commands(motion):
    for stamp_ns, x_m in ((10 * S, 1.0), (10 * S + S // 2, 1.1)):
        motion.measured(Odometry(robot="r1", stamp_ns=stamp_ns, x_m=x_m))
    motion.sensed(ranges(10 * S + S // 2), 0.5)
    assert seen(motion, 10 * S + S // 2, 0.5).moved.x_m == pytest.approx(0.1)


def test_an_old_frame_has_the_distances_of_its_moment_and_what_was_driven_since(motion):
    motion.sensed(ranges(10 * S + S // 4, 2.0), 0.25)
    found = seen(motion, 10 * S, 0.25)
    assert found.ranges.distances_m == (1.0,) * 12
    assert found.since.x_m == pytest.approx(0.125)


def test_nothing_is_known_before_the_first_frame_or_when_time_jumps_back(motion):
    fresh = FrameMotion()
    fresh.sensed(ranges(5 * S), 0.0)
    assert seen(fresh, 5 * S).moved == NO_MOTION
    assert seen(motion, 5 * S).moved == NO_MOTION
