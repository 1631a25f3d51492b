"""A flat picture placed on an equirectangular canvas, as in the thesis's figures 3.3 to 3.10."""

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from shared.geometry.perspective import PerspectiveView, pixel_centres
from shared.geometry.sphere import EquirectGrid, FloatArray, bearings_from_lonlat

Image = npt.NDArray[np.uint8]
FOV_RAD = math.pi / 2  # of the thesis's pictures (3.1)


@dataclass(frozen=True)
class Change:
    """What is done to a picture before it is placed.

    Attributes:
        name: latitude, longitude, blur, rotation or scale.
        level: degrees, pixels of standard deviation, degrees, or a factor.
        lat_deg: latitude of the picture's centre on the canvas.
        lon_deg: longitude of it.
    """

    name: str
    level: float
    lat_deg: float = 0.0
    lon_deg: float = 0.0


UNCHANGED = Change("none", 0.0)


def view_of(change: Change, side_px: int) -> PerspectiveView:
    """Where on the sphere the picture lies."""
    return PerspectiveView(
        side_px, side_px, FOV_RAD, math.radians(change.lon_deg), math.radians(change.lat_deg)
    )


def similarity_of(change: Change, side_px: int) -> FloatArray:
    """The known map (2, 3) from pixels of the original to pixels of the changed picture."""
    angle = change.level if change.name == "rotation" else 0.0
    factor = change.level if change.name == "scale" else 1.0
    middle = side_px / 2.0
    return np.asarray(cv2.getRotationMatrix2D((middle, middle), angle, factor), np.float64)


def changed_picture(picture: Image, change: Change) -> tuple[Image, npt.NDArray[np.bool_]]:
    """The changed picture and where it shows anything of the original, both (S, S)."""
    side = len(picture)
    # OpenCV counts from the centre of the first pixel, we from its corner.
    shift = np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]])
    known = np.vstack([similarity_of(change, side), [0.0, 0.0, 1.0]])
    matrix = (np.linalg.inv(shift) @ known @ shift)[:2]
    moved = cv2.warpAffine(picture, matrix, (side, side), flags=cv2.INTER_LINEAR)
    shown = cv2.warpAffine(np.full((side, side), 255, np.uint8), matrix, (side, side)) > 254
    if change.name == "blur" and change.level > 0.0:
        moved = cv2.GaussianBlur(moved, (0, 0), change.level)
    return np.asarray(moved, np.uint8), np.asarray(shown)


def placed(picture: Image, view: PerspectiveView, canvas_px: int) -> Image:
    """Canvas (canvas_px / 2, canvas_px), black where the picture is not."""
    grid = EquirectGrid(canvas_px, canvas_px // 2)
    pixels = view.pixels_from_bearings(grid.bearings_from_pixels(pixel_centres(canvas_px, canvas_px // 2)))
    at = np.nan_to_num(pixels - 0.5, nan=-10.0).astype(np.float32)
    return np.asarray(cv2.remap(picture, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderValue=0), np.uint8)


def rectified(lonlat_rad: npt.NDArray[np.float32], view: PerspectiveView) -> FloatArray:
    """Pixels (N, 2) of the placed picture at which keypoints lie; NaN behind it."""
    return view.pixels_from_bearings(bearings_from_lonlat(lonlat_rad.astype(np.float64)))
