"""Velocities to either type and back, within what the base can."""

import pytest

from services.ros.conversions.header import ConversionError
from services.ros.conversions.twist import Motion, MotionLimits, motion_of, twist_bytes
from tests.ros_messages import CODEC, TWIST, TWIST_STAMPED

MOTION = Motion(0.25, -0.5, 1.5)


@pytest.mark.parametrize("kind", [TWIST, TWIST_STAMPED])
def test_a_motion_comes_back_from_either_type(kind):
    payload = twist_bytes(CODEC, kind, MOTION, "base_link", 12.5)
    assert motion_of(CODEC.decode(kind, payload), kind) == MOTION


def test_a_stamped_one_has_the_robots_time_and_frame_and_zero_where_that_is_unknown():
    header = CODEC.decode(TWIST_STAMPED, twist_bytes(CODEC, TWIST_STAMPED, MOTION, "base", 12.5)).header
    assert (header.frame_id, header.stamp.sec, header.stamp.nanosec) == ("base", 12, 500_000_000)
    header = CODEC.decode(TWIST_STAMPED, twist_bytes(CODEC, TWIST_STAMPED, MOTION, "base", None)).header
    assert (header.stamp.sec, header.stamp.nanosec) == (0, 0)


def test_too_fast_a_motion_keeps_its_curve():
    limits = MotionLimits(0.5, 0.5, 1.0)
    assert limits.within(Motion(1.0, -0.5, 1.0)) == Motion(0.5, -0.25, 0.5)
    assert limits.within(Motion(0.1, 0.1, 0.1)) == Motion(0.1, 0.1, 0.1)


def test_a_base_is_told_nothing_of_an_axis_that_it_has_not():
    assert MotionLimits(0.5, 0.0, 1.0).within(Motion(0.5, 2.0, 0.5)) == Motion(0.5, 0.0, 0.5)


def test_nan_is_named():
    message = CODEC.make(TWIST)
    message.linear.x = float("nan")
    with pytest.raises(ConversionError, match="a velocity must be finite"):
        motion_of(message, TWIST)
