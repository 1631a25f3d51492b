"""What every source of pictures is: opened, read picture by picture, closed. Pure."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
import numpy.typing as npt
from pydantic import BaseModel, ConfigDict

from services.camera.camera_url import CameraUrl

Image = npt.NDArray[np.uint8]
MAX_PIXELS = 64_000_000
"""Largest picture taken; chosen, as of the feature service: more than 360-degree cameras give."""
MAX_PICTURE_BYTES = 16_000_000
"""Longest JPEG taken; chosen: a still of 72 megapixels has 12 MB, a preview 0.5."""


class SourceError(RuntimeError):
    """A source that gives no picture for now: it is opened anew. The text is one line for people."""


class EndOfPicturesError(SourceError):
    """A folder or a file has no further picture."""


@dataclass(frozen=True, eq=False)
class Picture:
    """One picture as it came: a JPEG's bytes, or (H, W, 3) BGR; and when, nanoseconds of this clock."""

    data: bytes | Image
    arrived_ns: int


@dataclass(frozen=True)
class CameraFacts:
    """What a camera says of itself; empty or None where it says nothing."""

    model: str = ""
    mode: str = ""
    battery_fraction: float | None = None


class Source(Protocol):
    """One opened camera, stream, folder or file. Only the thread that opened it touches it."""

    @property
    def facts(self) -> CameraFacts:
        """What the camera says of itself."""

    def read(self) -> Picture:
        """Wait for the next picture.

        Raises:
            BadPictureError: one came that cannot be used; the next one may be good.
            SourceError: none came in time, or the source is gone.
        """

    def close(self) -> None:
        """Give everything back."""


class NoOptions(BaseModel):
    """Of a source that needs none."""

    model_config = ConfigDict(frozen=True, extra="forbid")


O = TypeVar("O", bound=BaseModel)  # noqa: E741 - options


@dataclass(frozen=True)
class SourceKind(Generic[O]):
    """One kind of source: a plugin.

    Attributes:
        schemes: what its URLs begin with.
        example: of a URL, for error texts and pages.
        options: what may follow the question mark; None where that belongs to the camera.
        open: connect; SourceError where it cannot.
        delay_s: from exposure to arrival where nobody measured it.
        live: pictures are of now. The same one again means that the camera hangs.
        stepped: whether each picture waits until the last one was worked on.
    """

    schemes: tuple[str, ...]
    example: str
    options: type[O] | None
    open: Callable[[CameraUrl, O, threading.Event], Source]
    delay_s: float
    live: bool = True
    stepped: Callable[[Any], bool] = field(default=lambda _: False)
