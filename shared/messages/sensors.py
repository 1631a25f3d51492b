"""What a robot senses: one panorama and 12 distances. Robot -> everyone."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from shared.messages.base import SECTORS, Message, Name

BytesPerPixel = 3


class Frame(Message):
    """An equirectangular picture, centre column ahead, twice as wide as high."""

    SCHEMA: ClassVar[str] = "frame.v1"

    robot: Name
    lockstep: bool = False
    encoding: Literal["bgr8", "jpeg"]
    width_px: int = Field(ge=2, le=16_384)
    height_px: int = Field(ge=1, le=8_192)
    data: bytes = Field(max_length=64_000_000)

    @model_validator(mode="after")
    def _size_fits(self) -> "Frame":
        if self.width_px != 2 * self.height_px:
            raise ValueError(f"frame must be twice as wide as high, got {self.width_px} x {self.height_px}")
        expected = self.width_px * self.height_px * BytesPerPixel
        if self.encoding == "bgr8" and len(self.data) != expected:
            raise ValueError(f"bgr8 frame needs {expected} bytes, got {len(self.data)}")
        return self


class Ranges(Message):
    """Distances from the robot's centre, sector i centred on 30 i degrees, counter-clockwise."""

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
