"""Messages as Foxglove's own schemas: what its panels draw. Needs the extra `foxglove`."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from typing import Protocol

from foxglove import Schema
from foxglove.messages import (
    ArrowPrimitive,
    Color,
    CompressedImage,
    LaserScan,
    Log,
    LogLevel,
    Pose,
    Quaternion,
    SceneEntity,
    SceneEntityDeletion,
    SceneEntityDeletionType,
    SceneUpdate,
    Timestamp,
    Vector3,
)
from PIL import Image

from shared.messages.base import Message
from shared.messages.drive import Heading, Velocity
from shared.messages.missions import Event
from shared.messages.sensors import Frame, Ranges

JPEG_QUALITY = 85  # for people to look at
STEP_TOLERANCE_RAD = 1e-3  # 0.06 degrees: float32 angles round less
MAX_STAMP_NS = 2**32 * 10**9 - 1
"""Foxglove counts seconds in 32 bits."""

HEADING_LENGTH_M = 1.0  # seen beside the robot of 0.5 m
VELOCITY_M_PER_MPS = 1.25  # full speed indoors (0.4 m/s) is half a metre long
HEADING_COLOR = Color(r=0.2, g=0.4, b=1.0, a=1.0)
VELOCITY_COLOR = Color(r=0.1, g=0.7, b=0.3, a=1.0)
AVOIDING_COLOR = Color(r=1.0, g=0.5, b=0.0, a=1.0)

EVERY_STEP = {"heading", "hold"}
WARNINGS = {"failed", "lost", "suspended", "deleted", "gone", "unreachable", "blocked", "doubted", "replan"}
"""Words in the kind of a decision that went wrong: edge_failed, lost_mode."""


class NotDrawableError(ValueError):
    """A message that has no picture in Foxglove; the text says why."""


class FoxgloveMessage(Protocol):
    """Any message class of the foxglove-sdk."""

    @staticmethod
    def get_schema() -> Schema:
        """Name and definition of the class."""
        ...

    def encode(self) -> bytes:
        """The message as protobuf."""
        ...


@dataclass(frozen=True)
class Drawing:
    """One Foxglove message.

    Attributes:
        part: name of its channel below the key of what it was made from, "image" for topnav/r1/frame/image.
        message: of Foxglove.
    """

    part: str
    message: FoxgloveMessage


Draw = Callable[[Message, int], Sequence[Drawing]]
"""Drawings of a message that arrived at so many nanoseconds; none for a message it does not know."""


def draw(message: Message, arrived_ns: int) -> Sequence[Drawing]:
    """What Foxglove shows of a message beside its numbers.

    Args:
        message: any message of the bus.
        arrived_ns: when it was recorded; its time stamp where it belongs to no frame.

    Raises:
        NotDrawableError: distances at uneven angles.
    """
    stamp = timestamp(message, arrived_ns)
    if isinstance(message, Frame):
        return [Drawing("image", _image(message, stamp))]
    if isinstance(message, Ranges):
        return [Drawing("scan", _scan(message, stamp))]
    if isinstance(message, Heading):
        return [Drawing("arrow", _heading_arrow(message, stamp))]
    if isinstance(message, Velocity):
        return [Drawing("arrow", _velocity_arrow(message, stamp))]
    if isinstance(message, Event):
        return [Drawing("log", _log(message, stamp))]
    return []


def timestamp(message: Message, arrived_ns: int) -> Timestamp:
    """When the frame was taken that a message belongs to; when the message arrived if there is none."""
    stamp_ns = min(message.stamp_ns or arrived_ns, MAX_STAMP_NS)
    return Timestamp(stamp_ns // 10**9, stamp_ns % 10**9)


def rotation(yaw_rad: float) -> Quaternion:
    """A turn about the vertical axis, counter-clockwise."""
    return Quaternion(x=0.0, y=0.0, z=math.sin(yaw_rad / 2), w=math.cos(yaw_rad / 2))


def floor_pose(x_m: float, y_m: float, yaw_rad: float) -> Pose:
    """A pose on the floor."""
    return Pose(position=Vector3(x=x_m, y=y_m, z=0.0), orientation=rotation(yaw_rad))


def level(kind: str) -> LogLevel:
    """How bad a decision of this kind is."""
    if kind == "failed":
        return LogLevel.Error
    if WARNINGS & set(kind.split("_")):
        return LogLevel.Warning
    return LogLevel.Debug if kind in EVERY_STEP else LogLevel.Info


def _image(frame: Frame, stamp: Timestamp) -> CompressedImage:
    data = frame.data
    if frame.encoding == "bgr8":
        jpeg = BytesIO()
        picture = Image.frombytes("RGB", (frame.width_px, frame.height_px), data, "raw", "BGR")
        picture.save(jpeg, "JPEG", quality=JPEG_QUALITY)
        data = jpeg.getvalue()
    return CompressedImage(timestamp=stamp, frame_id=frame.robot, data=data, format="jpeg")


def _scan(ranges: Ranges, stamp: Timestamp) -> LaserScan:
    """The distances in the order of their angles: a LaserScan knows only its first and its last."""
    wrapped = [math.remainder(angle, math.tau) for angle in ranges.angles_rad]
    angles, distances = zip(*sorted(zip(wrapped, ranges.distances_m, strict=True)), strict=True)
    step = (angles[-1] - angles[0]) / (len(angles) - 1)
    ideal = [angles[0] + k * step for k in range(len(angles))]
    if step <= 0 or max(abs(a - b) for a, b in zip(angles, ideal, strict=True)) > STEP_TOLERANCE_RAD:
        raise NotDrawableError("the angles of the distances have no constant step")
    return LaserScan(
        timestamp=stamp,
        frame_id=ranges.robot,
        pose=floor_pose(0.0, 0.0, 0.0),
        start_angle=angles[0],
        end_angle=angles[-1],
        ranges=list(distances),
    )


def _heading_arrow(heading: Heading, stamp: Timestamp) -> SceneUpdate:
    length_m = HEADING_LENGTH_M if heading.action == "go" else 0.0
    name = f"{heading.robot} heading"
    return _arrow(name, heading.robot, stamp, heading.heading_rad, length_m, HEADING_COLOR)


def _velocity_arrow(velocity: Velocity, stamp: Timestamp) -> SceneUpdate:
    return _arrow(
        f"{velocity.robot} velocity",
        velocity.robot,
        stamp,
        math.atan2(velocity.left_mps, velocity.forward_mps),
        VELOCITY_M_PER_MPS * velocity.speed_mps,
        AVOIDING_COLOR if velocity.avoiding else VELOCITY_COLOR,
    )


def _arrow(
    name: str, robot: str, stamp: Timestamp, yaw_rad: float, length_m: float, color: Color
) -> SceneUpdate:
    """An arrow that replaces the last of its name, or takes it away where there is nothing to show.

    It has no lifetime: Foxglove counts that from the stamp, which is older than the message by the time that
    the planner thought.
    """
    if length_m == 0.0:
        gone = SceneEntityDeletion(timestamp=stamp, type=SceneEntityDeletionType.MatchingId, id=name)
        return SceneUpdate(deletions=[gone])
    arrow = ArrowPrimitive(
        pose=floor_pose(0.0, 0.0, yaw_rad),
        shaft_length=0.8 * length_m,
        shaft_diameter=0.03,
        head_length=0.2 * length_m,
        head_diameter=0.08,
        color=color,
    )
    entity = SceneEntity(timestamp=stamp, frame_id=robot, id=name, frame_locked=True, arrows=[arrow])
    return SceneUpdate(entities=[entity])


def _log(event: Event, stamp: Timestamp) -> Log:
    return Log(
        timestamp=stamp,
        level=level(event.kind),
        message=f"{event.kind.replace('_', ' ')}: {event.reason}",
        name=event.robot,
    )
