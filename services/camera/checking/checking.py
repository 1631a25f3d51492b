"""`topnav camera check`: settings, a look at the camera, and what follows from it."""

from collections.abc import Callable

import cv2
import numpy as np

from services.camera.checking.examining import examine
from services.camera.checking.report import Report
from services.camera.checking.watching import Paint, watch
from services.camera.frames import FrameMaker
from services.camera.mount.calibration_file import CalibrationFileError
from services.camera.service import fisheye_of, frame_settings
from services.camera.settings import CameraSettings
from services.camera.streaming.video import silence_libraries

Encoded = Callable[[str], bytes]
"""The marked picture in the format of a file's suffix; ValueError where there is none of that name."""


def check_camera(seconds: float, paint: Paint | None, seed: int) -> tuple[Report, Encoded | None]:
    """Look at the camera that the environment names (CAMERA_*).

    Args:
        seconds: how long.
        paint: turns a screen before the camera bright and dark, if the delay is to be measured.
        seed: of the times at which it does.

    Returns:
        The report, and a marked picture where a frame could be made.

    Raises:
        ValueError: wrong settings, or a calibration that cannot be used.
    """
    silence_libraries()
    settings = CameraSettings.from_environment()
    try:
        fisheye = fisheye_of(settings)
    except CalibrationFileError as error:
        raise ValueError(str(error)) from error
    maker = FrameMaker(frame_settings(settings), settings.orientation, fisheye)
    watched = watch(settings, seconds, paint, np.random.default_rng(seed))
    report, marked = examine(settings, maker, fisheye, watched)
    if marked is None:
        return report, None

    def encoded(suffix: str) -> bytes:
        try:
            return cv2.imencode(suffix, marked)[1].tobytes()
        except cv2.error as error:
            raise ValueError(f"a picture's file ends in .png or .jpg, got {suffix!r}") from error

    return report, encoded
