"""What the simulated robot senses as messages of ROS 2; the reverse of services/ros/conversions. Pure."""

import math
from typing import Any

import numpy as np

from services.ros.conversions.body import GRAVITY_MPS2, UNKNOWN
from services.ros.conversions.header import NS_PER_S
from services.ros.sensing import IMU, ODOMETRY, SCAN
from services.ros.wires.codec import Codec
from shared.messages.body import Odometry
from shared.messages.sensors import Direction, Frame, Ranges

PICTURE = "sensor_msgs/msg/CompressedImage"
NEAREST_M = 0.02
"""range_min of the scan; chosen: the body of the robot is further from its sensors."""


def picture_of(codec: Codec, frame: Frame) -> Any:
    """A CompressedImage of a frame, whose encoding must be jpeg."""
    message = _stamped(codec, PICTURE, frame.stamp_ns, "camera")
    message.format = "jpeg"
    message.data = np.frombuffer(frame.data, np.uint8)
    return message


def scan_of(codec: Codec, ranges: Ranges) -> Any:
    """A LaserScan of the distance sensors, which are spaced evenly from straight ahead; far is infinite."""
    message = _stamped(codec, SCAN, ranges.stamp_ns, "laser")
    distances_m = np.array(ranges.distances_m, dtype=np.float32)
    message.ranges = np.where(distances_m < ranges.max_range_m, distances_m, np.inf).astype(np.float32)
    message.angle_min, message.angle_increment = ranges.angles_rad[0], math.tau / len(distances_m)
    message.angle_max = message.angle_min + message.angle_increment * (len(distances_m) - 1)
    message.range_min, message.range_max = NEAREST_M, ranges.max_range_m
    return message


def odometry_of(codec: Codec, odometry: Odometry) -> Any:
    """An Odometry whose pose is where the wheels say that the robot is."""
    message = _stamped(codec, ODOMETRY, odometry.stamp_ns, "odom")
    message.child_frame_id = "base_link"
    pose, twist = message.pose.pose, message.twist.twist
    pose.position.x, pose.position.y = odometry.x_m, odometry.y_m
    pose.orientation.z, pose.orientation.w = math.sin(odometry.yaw_rad / 2), math.cos(odometry.yaw_rad / 2)
    twist.linear.x, twist.linear.y = odometry.forward_mps, odometry.left_mps
    twist.angular.z = odometry.turn_radps
    return message


def imu_of(codec: Codec, stamp_ns: int, gravity: Direction) -> Any:
    """An Imu that feels gravity and does not know its orientation nor its rates."""
    message = _stamped(codec, IMU, stamp_ns, "imu")
    message.orientation_covariance[0] = message.angular_velocity_covariance[0] = UNKNOWN
    felt = message.linear_acceleration
    felt.x, felt.y, felt.z = (-GRAVITY_MPS2 * part for part in gravity)
    return message


def _stamped(codec: Codec, kind: str, stamp_ns: int, frame: str) -> Any:
    message = codec.make(kind)
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp_ns, NS_PER_S)
    return message
