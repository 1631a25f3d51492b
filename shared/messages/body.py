"""What a robot may say of itself beside what it senses. Optional: nothing needs it. Robot -> everyone."""

from typing import Annotated, ClassVar

from pydantic import Field

from shared.messages.base import Bearing, Message, Name
from shared.messages.drive import Speed, TurnRate
from shared.messages.sensors import Gravity

Coordinate = Annotated[float, Field(ge=-1.0e6, le=1.0e6)]
"""Metres in a frame of the robot's own."""

Vector = tuple[
    Annotated[float, Field(ge=-1_000.0, le=1_000.0)],
    Annotated[float, Field(ge=-1_000.0, le=1_000.0)],
    Annotated[float, Field(ge=-1_000.0, le=1_000.0)],
]
"""Along x ahead, y left, z up of the robot."""


class Odometry(Message):
    """Where the robot has got to by its own wheels, and how it moves now.

    The pose drifts and never jumps: only the difference of two poses says something, the motion between their
    stamps, told in the earlier one's frame. Wheel encoders sum up to it; nav_msgs/Odometry has the same.

    Attributes:
        stamp_ns: when, by the clock that stamps the robot's frames and distances.
        x_m, y_m, yaw_rad: pose in a frame fixed where the robot began; the yaw may wrap.
        forward_mps, left_mps, turn_radps: as in `Velocity`, measured.
    """

    SCHEMA: ClassVar[str] = "odometry.v1"

    robot: Name
    x_m: Coordinate = 0.0
    y_m: Coordinate = 0.0
    yaw_rad: Bearing = 0.0
    forward_mps: Speed = 0.0
    left_mps: Speed = 0.0
    turn_radps: TurnRate = 0.0


class Imu(Message):
    """What an inertial sensor says; None of what it does not have.

    Attributes:
        gravity: where down is: unit vector in the robot's frame, (0, 0, -1) on a level floor.
        turn_radps: rates about the three axes.
        acceleration_mps2: of the robot, gravity taken away.
    """

    SCHEMA: ClassVar[str] = "imu.v1"

    robot: Name
    gravity: Gravity | None = None
    turn_radps: Vector | None = None
    acceleration_mps2: Vector | None = None


class Battery(Message):
    """How long the robot can go on; None of what it does not measure.

    Attributes:
        share: of a full charge, 0 to 1.
    """

    SCHEMA: ClassVar[str] = "battery.v1"

    robot: Name
    share: float | None = Field(default=None, ge=0.0, le=1.0)
    charging: bool | None = None
    voltage_v: float | None = Field(default=None, ge=0.0, le=10_000.0)
