"""A folder of pictures, in the order of their names, or a video file: at a rate, or one step at a time."""

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from services.camera.camera_url import CameraUrl
from services.camera.source import (
    MAX_PICTURE_BYTES,
    MAX_PIXELS,
    CameraFacts,
    EndOfPicturesError,
    Picture,
    Source,
    SourceError,
    SourceKind,
)
from services.camera.streaming.video import Video
from shared.jpeg import BadPictureError, jpeg_size, require_whole

JPEGS, OTHERS = (".jpg", ".jpeg"), (".png",)
FOLDER_RATE_HZ = 5.0
"""Chosen: the rate of the simulated camera."""
PNG_SIZE = slice(16, 24)
"""Where a PNG has its width and height, four bytes each (W3C PNG, 5.2 and 11.2.2)."""


class FileOptions(BaseModel):
    """How a folder or video is played.

    Attributes:
        rate: pictures a second; a video's own, else five.
        loop: begin again at the end.
        step: in place of a rate each picture waits until the last one's features are there.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    rate: float | None = Field(default=None, gt=0.0, le=240.0)
    loop: bool = False
    step: bool = False


class Folder:
    """The pictures of a folder."""

    def __init__(self, path: Path) -> None:
        self.facts, self.rate_hz = CameraFacts(), FOLDER_RATE_HZ
        self._path = path
        self._files = sorted(one for one in path.iterdir() if one.suffix.lower() in (*JPEGS, *OTHERS))
        if not self._files:
            raise SourceError(f"a folder with .jpg or .png pictures expected, {path} has none")
        self._left: Iterator[Path] = iter(self._files)

    def read(self) -> Picture:
        """The next file."""
        file = next(self._left, None)
        if file is None:
            raise EndOfPicturesError(f"{self._path} has no further picture")
        try:
            with file.open("rb") as stream:
                data = stream.read(4 * MAX_PICTURE_BYTES + 1)
        except OSError as error:
            raise BadPictureError(f"{file.name}: {error.strerror}") from error
        return Picture(_checked(file.name, data), time.time_ns())

    def rewind(self) -> None:
        """Begin again."""
        self._left = iter(self._files)

    def close(self) -> None:
        """Nothing to give back."""


class Paced:
    """A folder or a video, played."""

    def __init__(self, pictures: "Folder | Video", options: FileOptions, stop: threading.Event) -> None:
        self.facts = CameraFacts()
        self._pictures, self._options, self._stop = pictures, options, stop
        self._period_s = 1.0 / (options.rate or pictures.rate_hz or FOLDER_RATE_HZ)
        self._due_s = time.monotonic()
        self._read_any = False

    def read(self) -> Picture:
        """The next picture when its time has come; a reader that was held up skips none."""
        if not self._options.step:
            self._stop.wait(max(0.0, self._due_s - time.monotonic()))
            self._due_s = max(self._due_s + self._period_s, time.monotonic())
        try:
            picture = self._pictures.read()
        except BadPictureError:
            raise
        except SourceError as error:
            if not (self._options.loop and self._read_any):
                raise EndOfPicturesError(str(error)) from error
            self._pictures.rewind()
            picture = self._pictures.read()
        self._read_any = True
        return Picture(picture.data, time.time_ns())

    def close(self) -> None:
        """Close the file."""
        self._pictures.close()


def open_file(url: CameraUrl, options: FileOptions, stop: threading.Event) -> Source:
    """Open a folder or a video file."""
    path = Path(url.path).expanduser()
    if path.is_dir():
        return Paced(Folder(path), options, stop)
    if not path.is_file():
        raise SourceError(f"a folder of pictures or a video file expected, {path} is neither")
    return Paced(Video(str(path), cv2.CAP_FFMPEG, (), str(path)), options, stop)


def _checked(name: str, data: bytes) -> bytes | np.ndarray:
    """A JPEG as it is, anything else decoded; its size is looked at first."""
    try:
        if data[:2] == b"\xff\xd8":
            jpeg_size(data)
            require_whole(data)
            return data
        width, height = (int.from_bytes(part) for part in (data[PNG_SIZE][:4], data[PNG_SIZE][4:]))
        if data[:8] != b"\x89PNG\r\n\x1a\n" or not 0 < width * height <= MAX_PIXELS:
            raise BadPictureError(f"a JPEG or PNG of at most {MAX_PIXELS} pixels expected")
        picture = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
        if picture is None:
            raise BadPictureError("its data are damaged")
    except (BadPictureError, cv2.error) as error:
        raise BadPictureError(f"{name}: {str(error)[:160]}") from error
    return np.asarray(picture, dtype=np.uint8)


KIND = SourceKind(
    schemes=("file",),
    example="/path/of/a/folder?rate=5",
    options=FileOptions,
    open=open_file,
    delay_s=0.0,
    live=False,
    stepped=lambda options: options.step,
)
