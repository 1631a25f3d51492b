"""Devices, streams and files that OpenCV's VideoCapture opens, with FFmpeg's and V4L2's own time limits."""

import os
import time
from collections.abc import Sequence

import cv2

from services.camera.source import MAX_PIXELS, CameraFacts, Picture, SourceError

OPEN_MS, READ_MS = 5_000, 2_000
"""Chosen: a stream that is silent for two seconds is opened anew."""
STREAM_LIMITS = (cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, OPEN_MS, cv2.CAP_PROP_READ_TIMEOUT_MSEC, READ_MS)


class Video:
    """One opened capture.

    Raises:
        SourceError: it cannot be opened, or its pictures are too large.
    """

    def __init__(self, name: str, backend: int, parameters: Sequence[int], what: str) -> None:
        self._what, self.facts = what, CameraFacts()
        try:
            self._capture = cv2.VideoCapture(name, backend, list(parameters))
        except cv2.error as error:
            raise SourceError(f"{what} cannot be opened: {str(error)[:120]}") from error
        if not self._capture.isOpened():
            raise SourceError(f"{what} cannot be opened")
        width, height = (int(self._capture.get(one)) for one in (3, 4))
        if width * height > MAX_PIXELS:
            self.close()
            raise SourceError(f"at most {MAX_PIXELS} pixels expected, {what} has {width} x {height}")

    @property
    def rate_hz(self) -> float:
        """Pictures a second as the file or the device says; 0 where it does not."""
        rate = float(self._capture.get(cv2.CAP_PROP_FPS))
        return rate if 0.0 < rate < 1000.0 else 0.0

    def read(self) -> Picture:
        """Wait for the next picture."""
        try:
            came, picture = self._capture.read()
        except cv2.error as error:
            raise SourceError(f"{self._what} broke off: {str(error)[:120]}") from error
        if not came or picture is None or picture.ndim != 3:
            raise SourceError(f"{self._what} gives no further picture")
        return Picture(picture, time.time_ns())

    def rewind(self) -> None:
        """Begin a file again."""
        self._capture.set(cv2.CAP_PROP_POS_FRAMES, 0)

    def close(self) -> None:
        """Give the device or connection back."""
        self._capture.release()


def silence_libraries() -> None:
    """Let OpenCV and FFmpeg write nothing beside the log: what goes wrong is told in one line of it."""
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")  # AV_LOG_QUIET
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
