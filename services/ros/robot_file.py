"""The robot's file: its topics, how its sensors are mounted, what its base can do. Typed and checked."""

import math
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from services.ros.conversions.scan import Mount, Nothing
from services.ros.conversions.twist import VELOCITY_TYPES, MotionLimits
from services.ros.wires.codec import Distribution
from shared.yaml_reading import YamlFileError, read_yaml

Topic = Annotated[str, Field(pattern=r"^(/[A-Za-z_][A-Za-z0-9_]*)+$", max_length=200)]
"""A ROS name from its root: relative ones and ~ mean something else in each node."""

FrameName = Annotated[str, Field(max_length=200)]
Positive = Annotated[float, Field(gt=0.0, le=100.0)]
Degrees = Annotated[float, Field(ge=-360.0, le=360.0)]


class RobotFileError(ValueError):
    """A robot's file that cannot be used; names the file, the field, what was expected and what came."""


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class WireChoice(_Part):
    """How the robot is reached.

    Attributes:
        kind: rmw_zenoh and bridge (zenoh-bridge-ros2dds) need no ROS here; rclpy needs one.
        endpoint: of the robot's Zenoh router or bridge; not for rclpy.
        domain: ROS_DOMAIN_ID of the robot.
        namespace: of the bridge's configuration.
        distribution: the robot's ROS.
    """

    kind: Literal["rmw_zenoh", "bridge", "rclpy"]
    endpoint: str = Field(default="tcp/127.0.0.1:7447", max_length=200)
    domain: int = Field(default=0, ge=0, le=232)
    namespace: Topic | Literal["/"] = "/"
    distribution: Distribution = "jazzy"


class CameraTopic(_Part):
    """The panorama. Without it the frames are of `services/camera`.

    Attributes:
        ahead_deg: direction of the picture's middle column, counter-clockwise from straight ahead.
    """

    topic: Topic
    type: Literal["sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image"] = (
        "sensor_msgs/msg/CompressedImage"
    )
    frame: FrameName = ""
    ahead_deg: Degrees = 0.0

    @property
    def ahead_share(self) -> float:
        """Where straight ahead is in the picture, as a share of its width: columns go clockwise."""
        return (0.5 + self.ahead_deg / 360.0) % 1.0


class ScanTopic(_Part):
    """The laser scanner and its place on the robot; see `Mount`.

    Attributes:
        own_radius_m: hits nearer to the robot's centre are the robot.
        max_m: longest distance that is told; topnav asks for 4 indoors, 12 in the open.
        nothing: how the driver writes that nothing was in range.
    """

    topic: Topic
    frame: FrameName = ""
    x_m: float = Field(default=0.0, ge=-5.0, le=5.0)
    y_m: float = Field(default=0.0, ge=-5.0, le=5.0)
    yaw_deg: Degrees = 0.0
    upside_down: bool = False
    own_radius_m: float = Field(default=0.1, ge=0.0, le=5.0)
    max_m: Positive = 4.0
    nothing: Nothing = "inf"

    @property
    def mount(self) -> Mount:
        """Where it sits."""
        return Mount(self.x_m, self.y_m, math.radians(self.yaw_deg), self.upside_down)


class PlainTopic(_Part):
    """A topic of one type."""

    topic: Topic
    frame: FrameName = ""


class VelocityTopic(_Part):
    """What the base, or the guard before it, listens to.

    Attributes:
        type: "auto" is what its subscriber says.
        frame: frame_id of a TwistStamped.
    """

    topic: Topic
    type: Literal["auto", "geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist"] = "auto"
    frame: FrameName = "base_link"

    def types(self) -> tuple[str, ...]:
        """Types that may be sent, the better one first."""
        return VELOCITY_TYPES if self.type == "auto" else (self.type,)


class Limits(_Part):
    """Fastest motion; `left_mps` is 0 for a base that cannot roll sideways."""

    forward_mps: Positive
    left_mps: float = Field(default=0.0, ge=0.0, le=100.0)
    turn_radps: Positive

    @property
    def motion(self) -> MotionLimits:
        """The same for arithmetic."""
        return MotionLimits(self.forward_mps, self.left_mps, self.turn_radps)


class Guard(_Part):
    """The process before the base; `velocity.topic` is what it hears.

    Attributes:
        topic: what it sends to the base.
        stop_m: nothing comes nearer to the robot's centre than this.
        brake_mps2, accelerate_mps2: of the base.
        turn_radps2: of the base, both ways.
        command_ms, scan_ms: the robot stands where the last one is older.
    """

    topic: Topic
    type: Literal["auto", "geometry_msgs/msg/TwistStamped", "geometry_msgs/msg/Twist"] = "auto"
    frame: FrameName = "base_link"
    stop_m: Positive = 0.28
    brake_mps2: Positive = 1.0
    accelerate_mps2: Positive = 0.5
    turn_radps2: Positive = 3.0
    command_ms: int = Field(default=250, ge=50, le=1_000)
    scan_ms: int = Field(default=400, ge=50, le=1_000)

    def types(self) -> tuple[str, ...]:
        """Types that may be sent, the better one first."""
        return VELOCITY_TYPES if self.type == "auto" else (self.type,)


class RobotFile(_Part):
    """The whole file.

    Attributes:
        missions: where topnav's own services and topics stand; none where it is null.
    """

    name: str = Field(min_length=1, max_length=80)
    wire: WireChoice
    camera: CameraTopic | None = None
    scan: ScanTopic
    imu: PlainTopic | None = None
    odometry: PlainTopic | None = None
    battery: PlainTopic | None = None
    velocity: VelocityTopic
    limits: Limits
    guard: Guard | None = None
    missions: Topic | None = "/topnav"

    @model_validator(mode="after")
    def _guard_is_between(self) -> Self:
        if self.guard is not None and self.guard.topic == self.velocity.topic:
            raise ValueError(
                f"velocity.topic is what the guard hears and guard.topic what the base hears: two topics "
                f"expected, got {self.guard.topic} twice"
            )
        return self


def load_robot_file(path: Path) -> RobotFile:
    """Read and check a robot's file.

    Raises:
        RobotFileError: it cannot be read, or does not say what is needed.
    """
    try:
        return RobotFile.model_validate(read_yaml(path))
    except YamlFileError as error:
        raise RobotFileError(f"{path}: {' '.join(str(error).split())}") from error
    except ValidationError as error:
        problems = error.errors(include_url=False, include_input=True)
        first = problems[0]
        where = ".".join(map(str, first["loc"])) or "the file"
        came = "" if first["type"] in ("missing", "value_error") else f", got {first['input']!r:.60}"
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        reason = first["msg"].removeprefix("Value error, ")
        raise RobotFileError(f"{path}: {where}: {reason}{came}{more}") from error
