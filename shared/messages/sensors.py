"""What a robot senses: one panorama and 12 distances. Robot -> everyone."""

import math
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field, model_validator

from shared.messages.base import SECTORS, Message, Name

BytesPerPixel = 3
Direction = tuple[float, float, float]
NORM_TOLERANCE = 1e-3
"""Of a unit vector's length: what a vector of half-precision numbers is off by; all else is no direction."""


def _of_length_one(gravity: Direction) -> Direction:
    if abs(math.hypot(*gravity) - 1.0) > NORM_TOLERANCE:
        raise ValueError(f"gravity must be a unit vector, got length {math.hypot(*gravity):.4g}")
    return gravity


Gravity = Annotated[Direction, AfterValidator(_of_length_one)]
"""Where down is: a unit vector, x forward, y left, z up."""


class Frame(Message):
    """An equirectangular picture, centre column ahead, twice as wide as high.

    Attributes:
        gravity: where an IMU says down is: unit vector in the camera frame (x forward, y left, z up), so
            (0, 0, -1) of a camera that is level; None if nobody measured it.
    """

    SCHEMA: ClassVar[str] = "frame.v1"

    robot: Name
    lockstep: bool = False
    encoding: Literal["bgr8", "jpeg"]
    width_px: int = Field(ge=2, le=16_384)
    height_px: int = Field(ge=1, le=8_192)
    data: bytes = Field(max_length=64_000_000)
    gravity: Gravity | None = None

    @model_validator(mode="after")
    def _size_fits(self) -> "Frame":
        if self.width_px != 2 * self.height_px:
            raise ValueError(f"frame must be twice as wide as high, got {self.width_px} x {self.height_px}")
        expected = self.width_px * self.height_px * BytesPerPixel
        if self.encoding == "bgr8" and len(self.data) != expected:
            raise ValueError(f"bgr8 frame needs {expected} bytes, got {len(self.data)}")
        return self


class Ranges(Message):
    """Distances from the robot's centre, sector i centred on 30 i degrees, counter-clockwise.

    Attributes:
        step_s: in lockstep, simulated time from one frame to the next: stamps are of the wall clock.
    """

    SCHEMA: ClassVar[str] = "ranges.v1"

    robot: Name
    lockstep: bool = False
    angles_rad: tuple[Annotated[float, Field(ge=-6.3, le=6.3)], ...] = Field(
        min_length=SECTORS, max_length=SECTORS, fail_fast=True
    )
    distances_m: tuple[Annotated[float, Field(ge=0.0, le=1000.0)], ...] = Field(
        min_length=SECTORS, max_length=SECTORS, fail_fast=True
    )
    max_range_m: float = Field(gt=0.0, le=1000.0)
    step_s: float | None = Field(default=None, gt=0.0, le=60.0)
