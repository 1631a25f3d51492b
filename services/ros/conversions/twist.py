"""velocity.v1 within the base's limits to geometry_msgs/TwistStamped or Twist, and back. Pure."""

import math
from dataclasses import dataclass
from typing import Any

from services.ros.conversions.header import NS_PER_S, check_finite
from services.ros.wires.codec import Codec

TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
VELOCITY_TYPES = (TWIST_STAMPED, TWIST)


@dataclass(frozen=True)
class Motion:
    """How to move in the robot's frame: m/s ahead and to the left, rad/s counter-clockwise."""

    forward_mps: float = 0.0
    left_mps: float = 0.0
    turn_radps: float = 0.0

    @property
    def stands(self) -> bool:
        """Whether nothing moves."""
        return self.forward_mps == self.left_mps == self.turn_radps == 0.0

    def scaled(self, share: float) -> "Motion":
        """The same curve, driven slower."""
        return Motion(self.forward_mps * share, self.left_mps * share, self.turn_radps * share)


STAND = Motion()


@dataclass(frozen=True)
class MotionLimits:
    """Fastest motion of a base along each axis, both ways; 0 for one that it has not."""

    forward_mps: float
    left_mps: float
    turn_radps: float

    def within(self, motion: Motion) -> Motion:
        """The same curve, slower where one axis would be too fast; without the axes that the base has not."""
        share = 1.0
        told = Motion(
            motion.forward_mps if self.forward_mps else 0.0,
            motion.left_mps if self.left_mps else 0.0,
            motion.turn_radps if self.turn_radps else 0.0,
        )
        for wanted, most in (
            (told.forward_mps, self.forward_mps),
            (told.left_mps, self.left_mps),
            (told.turn_radps, self.turn_radps),
        ):
            if abs(wanted) > most > 0.0:
                share = min(share, most / abs(wanted))
        return told.scaled(share)


def twist_bytes(codec: Codec, kind: str, motion: Motion, frame: str, robot_time_s: float | None) -> bytes:
    """CDR of a Twist or TwistStamped.

    Args:
        codec: of the robot's ROS.
        kind: TWIST or TWIST_STAMPED.
        motion: what the base is to do.
        frame: frame_id, of a stamped one.
        robot_time_s: now by the robot's clock, which is what its controllers compare the stamp with: ours may
            be hours off. None leaves it zero, which they take for "now".
    """
    message = codec.make(kind)
    twist = message
    if kind == TWIST_STAMPED:
        twist, message.header.frame_id = message.twist, frame
        if robot_time_s is not None and robot_time_s > 0.0:
            seconds = math.floor(robot_time_s)
            message.header.stamp.sec = seconds
            message.header.stamp.nanosec = int((robot_time_s - seconds) * NS_PER_S)
    twist.linear.x, twist.linear.y = motion.forward_mps, motion.left_mps
    twist.angular.z = motion.turn_radps
    return codec.encode(kind, message)


def motion_of(message: Any, kind: str) -> Motion:
    """Motion of a Twist or TwistStamped.

    Raises:
        ConversionError: NaN or infinity.
    """
    twist = message.twist if kind == TWIST_STAMPED else message
    motion = Motion(twist.linear.x, twist.linear.y, twist.angular.z)
    check_finite("a velocity", (motion.forward_mps, motion.left_mps, motion.turn_radps))
    return motion
