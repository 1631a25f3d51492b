"""Messages of a ROS robot for tests, made by the codec that the service uses."""

import dataclasses
import io
import math
from typing import Any

import numpy as np
from PIL import Image

from services.ros.wires.codec import Codec

CODEC = Codec("jazzy")
SCAN, ODOMETRY = "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry"
IMU, BATTERY = "sensor_msgs/msg/Imu", "sensor_msgs/msg/BatteryState"
PICTURE, IMAGE = "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image"
TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def stamped(kind: str, at_s: float, frame: str = "") -> Any:
    """An empty message with a header; a stamp of zero is none."""
    message = CODEC.make(kind)
    message.header.frame_id = frame
    message.header.stamp.sec = math.floor(at_s)
    message.header.stamp.nanosec = int((at_s - math.floor(at_s)) * 1e9)
    return message


def scan(ranges_m: Any, at_s: float = 0.0, frame: str = "", **fields: Any) -> Any:
    """A LaserScan of one turn, counter-clockwise from straight ahead."""
    message = stamped(SCAN, at_s, frame)
    message.ranges = np.asarray(ranges_m, dtype=np.float32)
    message.angle_increment = math.tau / len(message.ranges)
    message.range_min, message.range_max = 0.05, 12.0
    for name, value in fields.items():
        setattr(message, name, value)
    return message


def room(yaw_rad: float = 0.0, x_m: float = 0.0, y_m: float = 0.0, count: int = 360) -> np.ndarray:
    """(count,) ranges in a room of 5 x 3 m with a pillar in one corner, seen from a pose in it."""
    bearings_rad = yaw_rad + np.arange(count) * math.tau / count
    along = np.stack([np.cos(bearings_rad), np.sin(bearings_rad)])
    with np.errstate(divide="ignore"):
        to_x_m = np.where(along[0] > 0, (3.0 - x_m) / along[0], (-2.0 - x_m) / along[0])
        to_y_m = np.where(along[1] > 0, (1.0 - y_m) / along[1], (-2.0 - y_m) / along[1])
    wall_m = np.minimum(np.abs(to_x_m), np.abs(to_y_m))
    pillar = np.abs(np.angle(np.exp(1j * (bearings_rad - 0.7)))) < 0.35
    return np.where(pillar, np.minimum(wall_m, 0.8), wall_m)


def odometry(yaw_rad: float = 0.0, x_m: float = 0.0, y_m: float = 0.0, at_s: float = 0.0) -> Any:
    """An Odometry of a robot that stands there."""
    message = stamped(ODOMETRY, at_s)
    pose = message.pose.pose
    pose.position.x, pose.position.y = x_m, y_m
    pose.orientation.z, pose.orientation.w = math.sin(yaw_rad / 2.0), math.cos(yaw_rad / 2.0)
    return message


def plain(message: Any) -> Any:
    """The message as lists and mappings, to be compared."""
    if dataclasses.is_dataclass(message):
        fields = [field.name for field in dataclasses.fields(message) if field.name != "__msgtype__"]
        return {name: plain(getattr(message, name)) for name in fields}
    if isinstance(message, np.ndarray):
        return message.tolist()
    return [plain(one) for one in message] if isinstance(message, list) else message


def jpeg(width_px: int = 64) -> bytes:
    """A grey panorama."""
    file = io.BytesIO()
    Image.new("RGB", (width_px, width_px // 2), (90, 90, 90)).save(file, "JPEG")
    return file.getvalue()
