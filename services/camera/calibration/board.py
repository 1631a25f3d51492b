"""The printed board, and its corners in a picture."""

from dataclasses import dataclass

import cv2
import numpy as np

from services.camera.mount.table import Image
from shared.geometry.sphere import FloatArray

COLUMNS, ROWS = 9, 6
"""Squares; chosen: they fill a sheet of A3 or A4, and the two sides cannot be confused."""
MARKER = 0.75
"""Side of a marker over that of a square; chosen, OpenCV's examples have 0.5 to 0.8."""
FEWEST = 8
"""Corners of a board in one lens that tell its pose well; chosen."""


@dataclass(frozen=True, eq=False)
class Corners:
    """Of one board in one lens: points (N, 2) on the board, in squares, and their pixels (N, 2)."""

    points: FloatArray
    pixels: FloatArray


def board() -> cv2.aruco.CharucoBoard:
    """The board; lengths are in squares."""
    markers = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_100)
    return cv2.aruco.CharucoBoard((COLUMNS, ROWS), 1.0, MARKER, markers)


def drawn_board(square_px: int) -> Image:
    """The board as a picture (ROWS, COLUMNS) * square_px with a white margin of half a square, grey."""
    size = COLUMNS * square_px + square_px, ROWS * square_px + square_px
    return np.asarray(board().generateImage(size, None, square_px // 2), dtype=np.uint8)


def corners_in(picture: Image, left_px: int, width_px: int) -> Corners | None:
    """Corners of the board in the columns of one lens, None where they are too few.

    Args:
        picture: (H, W, 3) BGR, of both lenses.
        left_px: first column of the lens.
        width_px: its columns.
    """
    grey = cv2.cvtColor(picture[:, left_px : left_px + width_px], cv2.COLOR_BGR2GRAY)
    pattern = board()
    found, ids, *_ = cv2.aruco.CharucoDetector(pattern).detectBoard(grey)
    if ids is None or len(ids) < FEWEST:
        return None
    points = np.asarray(pattern.getChessboardCorners(), dtype=np.float64)[ids.ravel(), :2]
    # OpenCV counts from the centre of the first pixel, this project from its corner.
    pixels = np.asarray(found, dtype=np.float64).reshape(-1, 2) + np.array([left_px + 0.5, 0.5])
    return Corners(points, pixels)
