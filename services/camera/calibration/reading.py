"""Pictures of the board, from a folder or a video file, to a calibration; and the board to print."""

import threading
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import cv2

from services.camera.calibration.board import drawn_board
from services.camera.calibration.calibrating import CalibrationError, calibrated, view_in
from services.camera.calibration.fitting import View
from services.camera.frames import decoded_picture, size_of
from services.camera.kinds import find_camera
from services.camera.mount.calibration_file import FisheyeCalibration
from services.camera.source import EndOfPicturesError, Source, SourceError
from shared.jpeg import BadPictureError

MOST_VIEWS = 60
"""Pictures with the board; chosen: more add minutes and no precision."""
SQUARE_PX = 300
"""Of the board to print; chosen: 260 dots an inch on A3."""


def calibration_of(where: str, told: Callable[[str], None]) -> FisheyeCalibration:
    """Calibrate from all pictures of a folder or video.

    Args:
        where: the folder or file.
        told: hears one line about each picture.

    Raises:
        CalibrationError: no pictures, pictures of several sizes, or too few that show the board.
    """
    try:
        with closing(
            find_camera(f"{Path(where).absolute()}?step=true").opener(threading.Event())()
        ) as source:
            views, size_px = _views(source, told)
    except SourceError as error:
        raise CalibrationError(str(error)) from error
    return calibrated(views, size_px)


def write_board(file: Path) -> None:
    """Write the board as a picture to print.

    Raises:
        OSError: it cannot be written there.
    """
    file.write_bytes(cv2.imencode(".png", drawn_board(SQUARE_PX))[1].tobytes())


def _views(source: Source, told: Callable[[str], None]) -> tuple[list[View], tuple[int, int]]:
    views: list[View] = []
    size_px, number = (0, 0), 0
    while len(views) < MOST_VIEWS:
        number += 1
        try:
            picture = source.read()
            size = size_of(picture)
            decoded = decoded_picture(picture, size[0])
        except EndOfPicturesError:
            break
        except BadPictureError as error:
            told(f"picture {number}: {error}")
            continue
        if size_px not in ((0, 0), size):
            raise CalibrationError(
                f"pictures of one size expected, picture {number} has {size[0]} x {size[1]} and not "
                f"{size_px[0]} x {size_px[1]}"
            )
        size_px = size
        view = view_in(decoded)
        counts = [0 if corners is None else len(corners.points) for corners in view]
        told(f"picture {number}: {counts[0]} corners in the left lens, {counts[1]} in the right one")
        if any(counts):
            views.append(view)
    return views, size_px
