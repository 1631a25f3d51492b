"""Streams over RTSP, as of network cameras and of streaming programs, `rtsp://192.168.1.20:8554/live`."""

import threading

import cv2

from services.camera.camera_url import CameraUrl
from services.camera.source import NoOptions, SourceKind
from services.camera.streaming.video import STREAM_LIMITS, Video

TYPICAL_DELAY_S = 0.3
"""Chosen: encoding, network and decoding of H.264. Measure yours."""


def open_rtsp(url: CameraUrl, options: NoOptions, stop: threading.Event) -> Video:
    """Open a stream; OpenCV has FFmpeg take TCP, so that no picture is half there."""
    del options, stop  # it waits for STREAM_LIMITS at most
    return Video(url.plain, cv2.CAP_FFMPEG, STREAM_LIMITS, "the stream")


KIND = SourceKind(
    schemes=("rtsp", "rtsps"),
    example="rtsp://192.168.1.20:8554/live",
    options=None,
    open=open_rtsp,
    delay_s=TYPICAL_DELAY_S,
)
