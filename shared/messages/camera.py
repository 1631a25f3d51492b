"""How a robot's camera is doing. Camera -> people."""

from typing import Annotated, ClassVar

from pydantic import Field

from shared.messages.base import Message, Name


class CameraState(Message):
    """Sent once a second, also while no picture comes.

    Attributes:
        seq: of the next frame.
        stamp_ns: when this was said.
        source: the camera's URL, without its password.
        problem: why no frame comes, or comes late; empty while all is well.
        model: as the camera says it.
        mode: as the camera says it, for example "image".
        battery_fraction: 1 is full; None where the camera does not say.
        rate_hz: pictures a second that the camera gives; the service may send fewer.
        delay_s: how far back frames are stamped, from their arrival.
        width_px: of the last frame, 0 before the first; as `height_px`.
    """

    SCHEMA: ClassVar[str] = "camera_state.v1"

    robot: Name
    source: Annotated[str, Field(max_length=200)]
    problem: str = Field(default="", max_length=300)
    model: str = Field(default="", max_length=80)
    mode: str = Field(default="", max_length=40)
    battery_fraction: float | None = Field(default=None, ge=0.0, le=1.0)
    rate_hz: float = Field(default=0.0, ge=0.0, le=1000.0)
    delay_s: float = Field(default=0.0, ge=0.0, le=60.0)
    width_px: int = Field(default=0, ge=0, le=16_384)
    height_px: int = Field(default=0, ge=0, le=8_192)
