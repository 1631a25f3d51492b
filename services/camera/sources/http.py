"""Streams over HTTP: Motion JPEG, read here and passed on as it comes, and any video that FFmpeg reads."""

import threading
import time

import cv2

from services.camera.camera_url import CameraUrl
from services.camera.source import CameraFacts, NoOptions, Picture, Source, SourceError, SourceKind
from services.camera.streaming.connection import Answer, Request, ask
from services.camera.streaming.multipart import Parts
from services.camera.streaming.video import STREAM_LIMITS, Video

ANSWER_S, SILENCE_S = 5.0, 2.0
"""Chosen, as for other streams."""
TYPICAL_DELAY_S = 0.2
"""Chosen: between a webcam and a THETA over wifi. Measure yours."""


class MotionJpeg:
    """One stream of JPEGs."""

    def __init__(self, answer: Answer) -> None:
        self.facts = CameraFacts()
        self._answer, self._parts = answer, Parts(answer, answer.content_type)

    def read(self) -> Picture:
        """The next picture of the stream."""
        self._answer.allow(SILENCE_S)
        return Picture(self._parts.next_jpeg(), time.time_ns())

    def close(self) -> None:
        """Close the connection."""
        self._answer.close()


def open_http(url: CameraUrl, options: NoOptions, stop: threading.Event) -> Source:
    """Look at what the server sends, and read it accordingly."""
    del options
    query = url.plain.partition("?")[2]
    path = (url.path or "/") + (f"?{query}" if query else "")
    answer = ask(url, Request("GET", path), stop, ANSWER_S)
    kind = answer.content_type.lower()
    try:
        if answer.status != 200:
            raise SourceError(f"HTTP {answer.status} in place of a stream")
        if kind.startswith("multipart/"):
            return MotionJpeg(answer)
        if kind.startswith(("text/", "image/")):
            raise SourceError(f"a stream of pictures expected, {kind[:60]!r} came: is it the camera's page?")
    except SourceError:
        answer.close()
        raise
    answer.close()
    return Video(url.plain, cv2.CAP_FFMPEG, STREAM_LIMITS, "the video")


KIND = SourceKind(
    schemes=("http", "https"),
    example="http://192.168.1.20:8080/video",
    options=None,
    open=open_http,
    delay_s=TYPICAL_DELAY_S,
)
