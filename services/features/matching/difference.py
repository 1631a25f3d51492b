"""How much of two small pictures differs that no way between them explains. Pure.

Rooms furnished alike share nearly all their keypoints; what tells them apart, a rug of another colour or
another picture on the wall, is a small part of what is seen. Dense optical flow takes out how things shift
from one spot to the other; what is left, locally, is the answer.
"""

import math

import cv2
import numpy as np
import numpy.typing as npt

from services.features.pipeline.thumbnail import from_thumbnail
from shared.geometry.perspective import pixel_centres
from shared.geometry.sphere import EquirectGrid, FloatArray
from shared.messages.matching import DIFFERENCES_SHAPE

WIDTH_PX, HEIGHT_PX = 256, 128
"""Pixels compared; chosen: 1.4 degrees each, a hundredth of a picture's area is a rug 2 m away."""
OVERLAP_PX = 32
"""Columns repeated beyond the seam, so that flow crosses it; chosen: 45 degrees."""
PATCH_PX = 9
"""Side of the patches in which a difference is averaged; chosen: 13 degrees, a picture on a wall 2 m away."""
BLUR_PX = 1.0
"""Standard deviation of a blur before pictures are compared: edges fall on pixels differently from spot to
spot. Of 12 spots in three development hostels, each seen from 1 to 5 cm beside it, the other three rooms
differ 3.6 times as much and more, 11 at the median; 1.6 and 3.2 without it. More than 1 px gains little."""
CELL_PX = WIDTH_PX // DIFFERENCES_SHAPE[1]
"""Side of the cells for which differences are told: half a patch."""
CROP_DEG = 45.0
"""Left out above and below, once the flow is known: further down lies floor nearer than the camera is high,
which shifts most from spot to spot, and there the robot sees itself."""

Picture = npt.NDArray[np.uint8]


def differences(current: bytes, target: bytes, yaw_rad: float) -> npt.NDArray[np.float32] | None:
    """Differences in the other picture, levels of the Lab colour space; None without both pictures.

    Shape and order are those of `NodeMatch.differences`.

    Args:
        current: JPEG of the equirectangular frame, centre column ahead.
        target: the same of the other picture, taken within some decimetres.
        yaw_rad: rotation from the frame's camera to the other's, counter-clockwise.
    """
    here, there = _decoded(current), _decoded(target)
    if here is None or there is None:
        return None
    turn_px = round(yaw_rad / math.tau * WIDTH_PX)
    turned = np.roll(there, -turn_px, axis=1)
    wide = _blurred(_beyond_the_seam(here)), _blurred(_beyond_the_seam(turned))
    left = np.minimum(_unexplained(*wide), _unexplained(*reversed(wide)))[:, OVERLAP_PX:-OVERLAP_PX]
    grid = EquirectGrid.cropped(WIDTH_PX, HEIGHT_PX, CROP_DEG)
    latitude_rad = grid.lonlat_from_pixels(pixel_centres(1, grid.height))[..., 1]
    weighted = np.roll(left[grid.row_slice] * np.cos(latitude_rad), turn_px, axis=1)
    middle = slice(CELL_PX // 2, None, CELL_PX)
    return np.asarray(np.sqrt(weighted[middle, middle]), np.float32)


def _unexplained(here: Picture, there: Picture) -> FloatArray:
    """Squared difference, averaged over patches, once what is seen there is shifted to where it is seen here.

    What one of two spots sees behind an edge is left in one direction, what is in one room only in both.
    """
    gray = [np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.uint8) for picture in (here, there)]
    flow = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM).calc(gray[0], gray[1], None)
    rows, columns = np.indices(gray[0].shape, dtype=np.float32)
    where = columns + flow[..., 0], rows + flow[..., 1]
    shifted = cv2.remap(there, *where, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    apart = _lab(here) - _lab(np.asarray(shifted, np.uint8))
    apart -= apart.mean(axis=(0, 1))  # another exposure is no difference
    return np.asarray(cv2.blur((apart**2).sum(axis=2), (PATCH_PX, PATCH_PX)), np.float64)


def _decoded(jpeg: bytes) -> Picture | None:
    picture = from_thumbnail(jpeg)
    if picture is None:
        return None
    return np.asarray(cv2.resize(picture, (WIDTH_PX, HEIGHT_PX), interpolation=cv2.INTER_AREA), np.uint8)


def _beyond_the_seam(picture: Picture) -> Picture:
    wide = cv2.copyMakeBorder(picture, 0, 0, OVERLAP_PX, OVERLAP_PX, cv2.BORDER_WRAP)
    return np.asarray(wide, np.uint8)


def _blurred(picture: Picture) -> Picture:
    return np.asarray(cv2.GaussianBlur(picture, (0, 0), BLUR_PX), np.uint8)


def _lab(picture: Picture) -> npt.NDArray[np.float32]:
    return np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2LAB), np.float32)
