"""Cameras that Linux knows as a device: UVC webcams, and whatever v4l2loopback offers, `v4l2:/dev/video0`."""

import threading
from typing import Annotated

import cv2
from pydantic import BaseModel, ConfigDict, Field

from services.camera.camera_url import CameraUrl
from services.camera.source import SourceKind
from services.camera.streaming.video import Video

TYPICAL_DELAY_S = 0.1
"""Chosen: exposure, readout, USB and decoding at 30 Hz. A THETA's H.264 takes 0.25: measure yours."""


class DeviceOptions(BaseModel):
    """What to ask the device for; it gives the nearest that it has, and decides on what is left out."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    width: int | None = Field(default=None, ge=64, le=16_384)
    height: int | None = Field(default=None, ge=64, le=8_192)
    rate: int | None = Field(default=None, ge=1, le=240)
    fourcc: Annotated[str, Field(pattern=r"^[A-Z0-9 ]{4}$")] | None = None


def open_device(url: CameraUrl, options: DeviceOptions, stop: threading.Event) -> Video:
    """Open a device; the compressed MJPG comes first, where USB is too slow for raw pictures."""
    del stop  # V4L2 waits ten seconds at most
    wanted = (
        (cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*options.fourcc) if options.fourcc else None),
        (cv2.CAP_PROP_FRAME_WIDTH, options.width),
        (cv2.CAP_PROP_FRAME_HEIGHT, options.height),
        (cv2.CAP_PROP_FPS, options.rate),
    )
    parameters = [number for pair in wanted if pair[1] is not None for number in pair if number is not None]
    return Video(url.path, cv2.CAP_V4L2, parameters, f"device {url.path}")


KIND = SourceKind(
    schemes=("v4l2",),
    example="v4l2:/dev/video0?width=1920&height=960",
    options=DeviceOptions,
    open=open_device,
    delay_s=TYPICAL_DELAY_S,
)
