"""Inspections: pictures of places, what changed in them, and how they are kept. Planner <-> others."""

from typing import ClassVar, Literal

from pydantic import Field

from shared.messages.base import Bearing, Message, Name, Part
from shared.messages.places import PlaceName

MAX_PICTURE_BYTES = 4_000_000
"""Of one picture as JPEG; chosen: four times a panorama of 2048 x 1024 pixels at quality 90."""


class Region(Part):
    """A part of a picture that changed, in the frame of the camera that took it.

    Attributes:
        bearing_rad: of the middle of the box round it.
        elevation_rad: of the same, above the horizon positive.
        width_rad, height_rad: of that box, in longitude and latitude.
        score: solid angle times how far it is beyond what counts, steradians.
    """

    bearing_rad: Bearing
    elevation_rad: Bearing
    width_rad: float = Field(ge=0.0, le=6.3)
    height_rad: float = Field(ge=0.0, le=3.2)
    score: float = Field(default=0.0, ge=0.0)


class CompareRequest(Message):
    """Compare the robot's frame `seq` with an earlier picture of the same place, and send it as a picture.

    Attributes:
        reference: JPEG of the earlier picture, equirectangular; empty where there is none.
    """

    SCHEMA: ClassVar[str] = "compare_request.v1"

    reference: bytes = Field(default=b"", max_length=MAX_PICTURE_BYTES)


class CompareReply(Message):
    """The frame as a picture, and what differs in it.

    Attributes:
        picture: JPEG of the frame.
        compared: whether both show the same place; without a reference, or where nothing agrees, False.
        why: why they were not compared.
        inliers: keypoints of both that agree with one motion of the camera.
        yaw_rad: turn from the reference's camera to the frame's, counter-clockwise.
        disparity_rad: by how much bearings differ beside the turn; nearly 0 at the same spot.
        regions: what changed, most significant first.
        took_ms: of the whole comparison.
    """

    SCHEMA: ClassVar[str] = "compare_reply.v1"

    picture: bytes = Field(max_length=MAX_PICTURE_BYTES)
    compared: bool = False
    why: str = Field(default="", max_length=200)
    inliers: int = Field(default=0, ge=0)
    yaw_rad: Bearing | None = None
    disparity_rad: float | None = Field(default=None, ge=0.0)
    regions: tuple[Region, ...] = Field(default=(), max_length=64, fail_fast=True)
    took_ms: float = Field(default=0.0, ge=0.0)


class Inspection(Part):
    """A visit to a place: its picture, and what changed in it since the visit before.

    Attributes:
        seq, stamp_ns: of the frame that became its picture.
        mission_id: of the mission that made it; round: of that mission, from 1.
        place: its name then.
        against_ns: `stamp_ns` of the visit it was compared with; None for the first, or where that failed.
        why: why it was not compared.
        yaw_rad, disparity_rad, inliers, regions: see `CompareReply`.
        picture: JPEG; empty where only the facts were asked for, or by now forgotten.
    """

    seq: int = Field(default=0, ge=0, lt=2**63)
    stamp_ns: int = Field(default=0, ge=0, lt=2**63)
    robot: Name
    mission_id: str = Field(pattern=r"^[A-Za-z0-9_-]{1,64}$")
    round: int = Field(ge=1)
    place: PlaceName
    against_ns: int | None = Field(default=None, ge=0, lt=2**63)
    why: str = Field(default="", max_length=200)
    inliers: int = Field(default=0, ge=0)
    yaw_rad: Bearing | None = None
    disparity_rad: float | None = Field(default=None, ge=0.0)
    regions: tuple[Region, ...] = Field(default=(), max_length=64, fail_fast=True)
    picture: bytes = Field(default=b"", max_length=MAX_PICTURE_BYTES)


class InspectionRequest(Message):
    """last: the newest visit to `place` with its picture; save: keep `inspection`.

    Attributes:
        mission_id, round: with last, of the visit under way: made again after a restart it is not the last.
        keep: with save, visits to that place whose pictures stay, the newest ones.
    """

    SCHEMA: ClassVar[str] = "inspection_request.v1"

    action: Literal["last", "save"]
    place: PlaceName
    mission_id: str = Field(default="", max_length=64)
    round: int = Field(default=0, ge=0)
    inspection: Inspection | None = None
    keep: int = Field(default=10, ge=2, le=1000)


class InspectionReply(Message):
    """The newest visit; None where there was none. After save, what was kept."""

    SCHEMA: ClassVar[str] = "inspection_reply.v1"

    inspection: Inspection | None = None
