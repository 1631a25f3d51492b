"""From pictures of the board to a calibration."""

import math

import cv2
import numpy as np

from services.camera.calibration.board import Corners, corners_in
from services.camera.calibration.fitting import (
    LENS,
    View,
    fitted,
    lens_of,
    pose_of_board,
    residuals,
    view_residuals,
)
from services.camera.mount.calibration_file import FisheyeCalibration, FisheyeLens
from services.camera.mount.lens import Lens
from services.camera.mount.table import Image
from shared.geometry.sphere import FloatArray

FEWEST_VIEWS, FEWEST_SHARED = 8, 3
"""Pictures in which a lens sees the board, and in which both do; chosen."""
RIM_RAD = math.radians(100.0)
"""First guess: the picture's rim is so far from the axis, as of lenses for 360-degree cameras."""
OUTLIER = 3.0
"""Views that are off by so many times the median are left out, once; chosen."""
MOST_OFF_PX_PER_WIDTH = 2.0 / 1600.0
"""A worse fit is none; chosen: two pixels of a picture of 1600 columns are half a degree."""
AHEAD = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""R_camera_lens of the first lens: the camera's frame is its own, x ahead, y left, z up."""


class CalibrationError(ValueError):
    """The pictures tell too little; the text says what to add."""


def view_in(picture: Image) -> View:
    """What both lenses see of the board in a picture (H, W, 3): the left half is the first lens's."""
    half = picture.shape[1] // 2
    return corners_in(picture, 0, half), corners_in(picture, half, half)


def calibrated(views: list[View], size_px: tuple[int, int]) -> FisheyeCalibration:
    """The calibration that explains all views.

    Args:
        views: of pictures of one size; those without any board are ignored.
        size_px: width and height of the pictures.

    Raises:
        CalibrationError: too few views, or no lens explains them.
    """
    views = [view for view in views if view != (None, None)]
    _require_enough(views)
    width_px, height_px = size_px
    scale_px = height_px / 2.0 / RIM_RAD
    unknowns = fitted(_first_guess(views, size_px, scale_px), views, scale_px)
    off = _rms_by_view(unknowns, views, scale_px)
    kept = [n for n in range(len(views)) if off[n] <= OUTLIER * float(np.median(off))]
    if len(kept) < len(views):
        poses = unknowns[2 * LENS + 6 :].reshape(-1, 6)[kept]
        views = [views[n] for n in kept]
        _require_enough(views)
        unknowns = fitted(np.concatenate([unknowns[: 2 * LENS + 6], poses.ravel()]), views, scale_px)
    error_px = math.sqrt(2.0 * float(np.mean(residuals(unknowns, views, scale_px) ** 2)))
    if error_px > MOST_OFF_PX_PER_WIDTH * width_px:
        raise CalibrationError(
            f"no pair of lenses explains the corners: they are off by {error_px:.1f} pixels; "
            "is the board flat, is the picture two fisheyes side by side?"
        )
    second = cv2.Rodrigues(unknowns[2 * LENS : 2 * LENS + 3])[0]
    first, other = lens_of(unknowns[:LENS], scale_px), lens_of(unknowns[LENS : 2 * LENS], scale_px)
    lenses = (
        _written(first, AHEAD, [view[0] for view in views], "left"),
        _written(other, AHEAD @ second.T, [view[1] for view in views], "right"),
    )
    return FisheyeCalibration(
        width_px=width_px, height_px=height_px, lenses=lenses, error_px=error_px, pictures=len(views)
    )


def _require_enough(views: list[View]) -> None:
    first, second = (sum(view[which] is not None for view in views) for which in (0, 1))
    both = sum(None not in view for view in views)
    if min(first, second) < FEWEST_VIEWS or both < FEWEST_SHARED:
        raise CalibrationError(
            f"the board in {FEWEST_VIEWS} pictures of each lens and in {FEWEST_SHARED} of both at once "
            f"expected, found it in {first}, {second} and {both}: hold it nearer, in better light, "
            "and beside the camera where both lenses see it"
        )


def _first_guess(views: list[View], size_px: tuple[int, int], scale_px: float) -> FloatArray:
    half_px, height_px = size_px[0] // 2, size_px[1]
    centres = [(half_px / 2.0, height_px / 2.0), (1.5 * half_px, height_px / 2.0)]
    lenses = [Lens(scale_px, centre) for centre in centres]
    poses = [
        [
            None if corners is None else pose_of_board(corners, lens)
            for corners, lens in zip(v, lenses, strict=True)
        ]
        for v in views
    ]
    turns = [two[0] @ one[0].T for one, two in poses if one is not None and two is not None]
    u, _, vt = np.linalg.svd(np.sum(turns, axis=0))
    second = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    guess = [np.array([1.0, *(np.array(centre) / scale_px), 0.0, 0.0, 0.0, 0.0]) for centre in centres]
    guess += [cv2.Rodrigues(second)[0].ravel(), np.zeros(3)]
    for one, two in poses:
        if one is None:
            assert two is not None
            one = second.T @ two[0], second.T @ two[1]
        guess += [cv2.Rodrigues(one[0])[0].ravel(), one[1]]
    return np.concatenate(guess)


def _rms_by_view(unknowns: FloatArray, views: list[View], scale_px: float) -> list[float]:
    lenses = lens_of(unknowns[:LENS], scale_px), lens_of(unknowns[LENS : 2 * LENS], scale_px)
    off = (view_residuals(unknowns, number, view, lenses) for number, view in enumerate(views))
    return [float(np.sqrt(np.mean(one**2))) for one in off]


def _written(lens: Lens, rotation: FloatArray, seen: list[Corners | None], name: str) -> FisheyeLens:
    """One lens of the file, which sees as far as corners were found."""
    pixels = np.concatenate([corners.pixels for corners in seen if corners is not None])
    u, v = (pixels - np.array(lens.centre_px)).T
    sees_rad = float(np.max(lens.angle_rad(np.hypot(u, v))))
    if sees_rad < math.pi / 2.0 or not lens.grows_to(sees_rad):
        raise CalibrationError(
            f"corners up to 90 degrees from the axis expected, the {name} lens has them up to "
            f"{math.degrees(sees_rad):.0f}: hold the board beside the camera, too"
        )
    rows = tuple(tuple(round(float(x), 9) for x in row) for row in rotation)
    return FisheyeLens.model_validate(
        {
            "focal_px": lens.focal_px,
            "centre_px": lens.centre_px,
            "distortion": lens.distortion,
            "rotation": rows,
            "sees_deg": math.degrees(sees_rad),
        }
    )
