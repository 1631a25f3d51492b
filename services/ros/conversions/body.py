"""nav_msgs/Odometry, sensor_msgs/Imu and BatteryState to odometry.v1, imu.v1 and battery.v1. Pure.

All three are optional for topnav; what is wrong in them is named and left out.
"""

import math
from typing import Any

from pydantic import ValidationError

from services.ros.conversions.header import ConversionError, check_finite
from shared.messages.body import Battery, Imu, Odometry

NORM_TOLERANCE = 0.05
"""Of a quaternion's length; chosen: single precision and a driver that does not normalise."""
GRAVITY_MPS2 = 9.80665
GRAVITY_SHARE = 0.15
"""Of gravity, by which an acceleration may differ and still say where down is; chosen: it brakes."""
UNKNOWN = -1.0
"""First element of a covariance whose quantity the sensor does not have (sensor_msgs/Imu)."""
CHARGING, DISCHARGING, NOT_CHARGING, FULL = 1, 2, 3, 4
"""sensor_msgs/BatteryState, power_supply_status."""


def odometry_of(message: Any, robot: str, seq: int, stamp_ns: int) -> Odometry:
    """Convert nav_msgs/Odometry, whose pose is on the floor and whose twist is in the robot's frame.

    Raises:
        ConversionError: NaN, no unit quaternion, or motion no robot makes.
    """
    pose, twist = message.pose.pose, message.twist.twist
    values = (pose.position.x, pose.position.y, twist.linear.x, twist.linear.y, twist.angular.z)
    check_finite("pose and velocity", values)
    x, y, z, w = _unit(pose.orientation)
    try:
        return Odometry(
            seq=seq, stamp_ns=stamp_ns, robot=robot,
            x_m=pose.position.x, y_m=pose.position.y,
            yaw_rad=math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
            forward_mps=twist.linear.x, left_mps=twist.linear.y, turn_radps=twist.angular.z,
        )  # fmt: skip
    except ValidationError as error:
        raise ConversionError(_first(error)) from error


def imu_of(message: Any, robot: str, seq: int, stamp_ns: int) -> Imu:
    """Convert sensor_msgs/Imu, which must be aligned with the robot (x ahead, y left, z up).

    Down is taken from the orientation, else from the acceleration of a robot that hardly accelerates.

    Raises:
        ConversionError: NaN, or gravity that points up: it is mounted upside down.
    """
    acceleration, rate = message.linear_acceleration, message.angular_velocity
    measured = (acceleration.x, acceleration.y, acceleration.z)
    has_acceleration = message.linear_acceleration_covariance[0] != UNKNOWN
    has_rate = message.angular_velocity_covariance[0] != UNKNOWN
    if has_acceleration:
        check_finite("an acceleration", measured)
    if has_rate:
        check_finite("a rate", (rate.x, rate.y, rate.z))
    down = _down(message, measured if has_acceleration else None)
    if down is not None and down[2] > 0.0:
        raise ConversionError("gravity points up: is the sensor mounted upside down?")
    own = None
    if down is not None and has_acceleration:
        own = tuple(a + GRAVITY_MPS2 * g for a, g in zip(measured, down, strict=True))
    try:
        return Imu(
            seq=seq, stamp_ns=stamp_ns, robot=robot, gravity=down,
            turn_radps=(rate.x, rate.y, rate.z) if has_rate else None, acceleration_mps2=own,
        )  # fmt: skip
    except ValidationError as error:
        raise ConversionError(_first(error)) from error


def battery_of(message: Any, robot: str, seq: int, stamp_ns: int) -> Battery:
    """Convert sensor_msgs/BatteryState; NaN is what it does not measure.

    Raises:
        ConversionError: a percentage that is none, as of drivers that say 87 for 0.87.
    """
    share, volts = message.percentage, message.voltage
    if math.isfinite(share) and not 0.0 <= share <= 1.0:
        raise ConversionError(f"percentage: a share from 0 to 1 expected, got {share:g}")
    status = message.power_supply_status
    known = status in (CHARGING, DISCHARGING, NOT_CHARGING, FULL)
    return Battery(
        seq=seq, stamp_ns=stamp_ns, robot=robot,
        share=share if math.isfinite(share) else None,
        charging=status in (CHARGING, FULL) if known else None,
        voltage_v=volts if math.isfinite(volts) and 0.0 <= volts <= 10_000.0 else None,
    )  # fmt: skip


def _unit(orientation: Any) -> tuple[float, float, float, float]:
    values = (orientation.x, orientation.y, orientation.z, orientation.w)
    length = math.hypot(*values)
    if not abs(length - 1.0) <= NORM_TOLERANCE:  # also of NaN
        raise ConversionError(f"an orientation is a unit quaternion, got length {length:.4g}")
    x, y, z, w = (value / length for value in values)
    return x, y, z, w


def _down(message: Any, measured: tuple[float, float, float] | None) -> tuple[float, float, float] | None:
    """Unit vector of gravity in the sensor's frame; None if nothing says where it is."""
    orientation = message.orientation
    some = any((orientation.x, orientation.y, orientation.z, orientation.w))
    if message.orientation_covariance[0] != UNKNOWN and some:
        x, y, z, w = _unit(orientation)
        return (-2.0 * (x * z - w * y), -2.0 * (y * z + w * x), -(1.0 - 2.0 * (x * x + y * y)))
    if measured is None:
        return None
    length = math.hypot(*measured)
    if abs(length - GRAVITY_MPS2) > GRAVITY_SHARE * GRAVITY_MPS2:
        return None
    return (-measured[0] / length, -measured[1] / length, -measured[2] / length)


def _first(error: ValidationError) -> str:
    problem = error.errors(include_url=False)[0]
    return f"{'.'.join(map(str, problem['loc']))}: {problem['msg']}"
