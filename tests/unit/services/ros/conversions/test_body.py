"""Odometry, IMU and battery as topnav has them, and what is wrong in them by name."""

import math

import pytest

from services.ros.conversions.body import battery_of, imu_of, odometry_of
from services.ros.conversions.header import ConversionError, check_frame, stamp_s
from tests.ros_messages import BATTERY, CODEC, IMU, odometry, stamped

NAN = float("nan")


def imu(acceleration=(0.0, 0.0, 9.81), oriented=False):
    message = stamped(IMU, 1.0)
    for name, value in zip("xyz", acceleration, strict=True):
        setattr(message.linear_acceleration, name, value)
    if not oriented:
        message.orientation_covariance[0] = -1.0
    return message


def test_odometry_keeps_pose_and_velocity():
    message = odometry(yaw_rad=2.0, x_m=1.0, y_m=-3.0)
    message.twist.twist.linear.x, message.twist.twist.angular.z = 0.25, -0.5
    told = odometry_of(message, "r1", 7, 99)
    assert (told.x_m, told.y_m, told.forward_mps, told.turn_radps) == (1.0, -3.0, 0.25, -0.5)
    assert told.yaw_rad == pytest.approx(2.0)
    assert (told.robot, told.seq, told.stamp_ns) == ("r1", 7, 99)


def test_odometry_without_sense_is_named():
    bad = odometry(x_m=NAN)
    with pytest.raises(ConversionError, match="pose and velocity must be finite"):
        odometry_of(bad, "r1", 0, 0)
    bad = odometry()
    bad.pose.pose.orientation.w = 0.0
    with pytest.raises(ConversionError, match="unit quaternion, got length 0"):
        odometry_of(bad, "r1", 0, 0)
    bad = odometry()
    bad.twist.twist.linear.x = 300.0
    with pytest.raises(ConversionError, match="forward_mps"):
        odometry_of(bad, "r1", 0, 0)


def test_a_level_sensor_that_stands_says_where_down_is():
    told = imu_of(imu(), "r1", 0, 0)
    assert told.gravity == pytest.approx((0.0, 0.0, -1.0))
    assert told.acceleration_mps2 == pytest.approx((0.0, 0.0, 0.0), abs=0.01)


def test_the_orientation_says_where_down_is_where_there_is_one():
    message = imu(oriented=True, acceleration=(3.0, 0.0, 9.81))
    message.orientation.y, message.orientation.w = math.sin(0.1), math.cos(0.1)  # nose down by 0.2 rad
    told = imu_of(message, "r1", 0, 0)
    assert told.gravity == pytest.approx((math.sin(0.2), 0.0, -math.cos(0.2)))


def test_a_robot_that_brakes_hard_says_nothing_of_down():
    assert imu_of(imu(acceleration=(9.0, 0.0, 9.81)), "r1", 0, 0).gravity is None


def test_a_sensor_that_is_upside_down_or_says_nan_is_named():
    with pytest.raises(ConversionError, match="upside down"):
        imu_of(imu(acceleration=(0.0, 0.0, -9.81)), "r1", 0, 0)
    with pytest.raises(ConversionError, match="an acceleration must be finite"):
        imu_of(imu(acceleration=(NAN, 0.0, 9.81)), "r1", 0, 0)


def test_quantities_that_a_sensor_says_it_has_not_are_left_out():
    message = imu(acceleration=(NAN, NAN, NAN))
    message.linear_acceleration_covariance[0] = message.angular_velocity_covariance[0] = -1.0
    told = imu_of(message, "r1", 0, 0)
    assert (told.gravity, told.turn_radps, told.acceleration_mps2) == (None, None, None)


def test_a_battery_tells_its_share_and_leaves_out_what_it_does_not_measure():
    message = CODEC.make(BATTERY, percentage=0.5, voltage=NAN, power_supply_status=2)
    told = battery_of(message, "r1", 0, 0)
    assert (told.share, told.charging, told.voltage_v) == (0.5, False, None)
    message.percentage, message.power_supply_status, message.voltage = NAN, 0, 12.5
    told = battery_of(message, "r1", 0, 0)
    assert (told.share, told.charging, told.voltage_v) == (None, None, 12.5)


def test_a_percentage_in_hundredths_is_named():
    with pytest.raises(ConversionError, match="a share from 0 to 1 expected, got 87"):
        battery_of(CODEC.make(BATTERY, percentage=87.0), "r1", 0, 0)


def test_stamps_and_frames():
    assert stamp_s(stamped(IMU, 12.5)) == 12.5
    assert stamp_s(stamped(IMU, 0.0)) is None
    check_frame(stamped(IMU, 0.0, "imu"), "")
    with pytest.raises(ConversionError, match="frame 'imu' expected, got 'laser'"):
        check_frame(stamped(IMU, 0.0, "laser"), "imu")
