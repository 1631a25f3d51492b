"""Settings of the camera service, from CAMERA_* variables."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, field_validator
from pydantic_settings import SettingsConfigDict

from services.camera.kinds import CameraAddress, find_camera
from services.camera.mount.orientation import Orientation
from shared.settings import ServiceSettings

Angle = Annotated[float, Field(ge=-180.0, le=180.0)]
OptionalMs = Annotated[float | None, BeforeValidator(lambda value: None if value == "" else value)]


class CameraSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        url: of the camera, deploy/CAMERAS.md.
        roll_deg: how far the mount lifts the camera's left side; 180 hangs upside-down. This one and the
            next are told by `topnav camera check`, from upright edges in sight.
        pitch_deg: how far it puts the camera's nose down.
        heading_deg: how far to the robot's left the picture's centre looks.
        mirrored: the camera swaps left and right.
        delay_ms: from exposure to arrival, measured by `topnav camera check --flash`; none: what is usual for
            such a camera.
        rate_hz: most frames a second; newer pictures take the place of older ones.
        width_px: most columns of a frame: wider pictures are scaled down.
        encoding: jpeg passes a camera's own pictures on where it can; bgr8 is exact and ten times as long.
        jpeg_quality: of pictures that are encoded here.
    """

    model_config = SettingsConfigDict(env_prefix="CAMERA_")

    url: str = Field(default="", validate_default=True, repr=False)
    roll_deg: Angle = 0.0
    pitch_deg: Annotated[float, Field(ge=-90.0, le=90.0)] = 0.0
    heading_deg: Angle = 0.0
    mirrored: bool = False
    delay_ms: OptionalMs = Field(default=None, ge=0.0, le=10_000.0)
    rate_hz: float = Field(default=10.0, gt=0.0, le=60.0)
    width_px: int = Field(default=1920, ge=64, le=8192, multiple_of=4)
    encoding: Literal["jpeg", "bgr8"] = "jpeg"
    jpeg_quality: int = Field(default=92, ge=1, le=100)

    @field_validator("url")
    @classmethod
    def _names_a_camera(cls, url: str) -> str:
        find_camera(url)
        return url

    @property
    def camera(self) -> CameraAddress:
        """What the URL names."""
        return find_camera(self.url)

    @property
    def orientation(self) -> Orientation:
        """How the camera sits on the robot."""
        return Orientation.from_degrees(self.roll_deg, self.pitch_deg, self.heading_deg, self.mirrored)

    @property
    def delay_s(self) -> float:
        """From exposure to arrival, seconds."""
        return self.camera.kind.delay_s if self.delay_ms is None else self.delay_ms / 1000.0
