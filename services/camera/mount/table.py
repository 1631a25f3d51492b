"""From what a camera gives to a panorama as the robot needs it: one table for `cv2.remap`. Pure.

Level, heading, mirroring, two fisheyes and the final size are all in the one table, so a picture is resampled
once however the camera sits.
"""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from services.camera.mount.calibration_file import FisheyeCalibration
from services.camera.mount.orientation import Orientation
from services.camera.mount.seam import SeamMask
from shared.geometry.perspective import pixel_centres
from shared.geometry.sphere import EquirectGrid, FloatArray

Image = npt.NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class PanoramaTable:
    """Makes panoramas, (H, 2H, 3) BGR, of pictures of one size.

    Attributes:
        map_fixed: (H, 2H, 2) int16 source pixels, as cv2.convertMaps has them: half the time of floats.
        map_fraction: (H, 2H) uint16, what they lack of the exact place.
        wraps: the picture is a panorama, whose columns go on at the other side.
        mask: blurs what lies at the seam of two fisheyes.
    """

    map_fixed: npt.NDArray[np.int16]
    map_fraction: npt.NDArray[np.uint16]
    wraps: bool
    mask: SeamMask | None = None

    def applied(self, picture: Image) -> Image:
        """Resample one picture."""
        border = cv2.BORDER_WRAP if self.wraps else cv2.BORDER_CONSTANT
        remapped = cv2.remap(picture, self.map_fixed, self.map_fraction, cv2.INTER_LINEAR, borderMode=border)
        panorama = np.ascontiguousarray(remapped, dtype=np.uint8)
        if self.mask is not None:
            self.mask.blur(panorama)
        return panorama


def from_panorama(width_px: int, source_width_px: int, orientation: Orientation) -> PanoramaTable:
    """Table that turns a panorama to the robot's frame.

    Args:
        width_px: columns of the result.
        source_width_px: columns of what the camera gives, twice its rows.
        orientation: of the camera on the robot.
    """
    source = EquirectGrid(source_width_px, source_width_px // 2)
    pixels = source.pixels_from_bearings(_camera_bearings(width_px, orientation))
    u = source.width - pixels[..., 0] if orientation.mirrored else pixels[..., 0]
    rows = np.clip(pixels[..., 1] - 0.5, 0.0, source.height - 1.0)  # wrapping would join top and bottom
    fixed, fraction = _fixed_point(u - 0.5, rows)
    return PanoramaTable(fixed, fraction, wraps=True)


def from_fisheyes(
    width_px: int, calibration: FisheyeCalibration, orientation: Orientation, mask_rad: float = 0.0
) -> PanoramaTable:
    """Table that makes a panorama of a picture with two fisheyes.

    Each bearing is taken from the lens whose axis is nearer, in proportion to how far the lenses see. What
    neither sees stays black.

    Args:
        width_px: columns of the result.
        calibration: of the two lenses.
        orientation: of the camera on the robot.
        mask_rad: half the width of the band along the seam that is blurred; 0 blurs nothing.
    """
    places, shares = _in_lenses(width_px, calibration, orientation)
    pixels = np.where((shares[0] <= shares[1])[..., None], places[0], places[1])
    fixed, fraction = _fixed_point(pixels[..., 0] - 0.5, pixels[..., 1] - 0.5)
    mask = None
    if mask_rad > 0.0:
        wider = np.deg2rad((calibration.lenses[0].sees_deg + calibration.lenses[1].sees_deg) / 2.0)
        mask = SeamMask.along(np.abs(shares[0] - shares[1]) / 2.0 * wider, mask_rad)
    return PanoramaTable(fixed, fraction, wraps=False, mask=mask)


def first_lens_sees(
    width_px: int, calibration: FisheyeCalibration, orientation: Orientation
) -> npt.NDArray[np.bool_]:
    """Which pixels (H, W) of such a panorama are of the first lens."""
    _, shares = _in_lenses(width_px, calibration, orientation)
    return np.asarray(shares[0] <= shares[1], dtype=np.bool_)


def _in_lenses(
    width_px: int, calibration: FisheyeCalibration, orientation: Orientation
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Pixels (H, W, 2) of each lens, and at which share (H, W) of how far it sees they lie."""
    bearings = _camera_bearings(width_px, orientation)
    if orientation.mirrored:
        bearings = bearings * np.array([1.0, -1.0, 1.0])
    places, shares = [], []
    for one in calibration.lenses:
        pixels, theta = one.lens.pixels(bearings @ one.rotation_camera_lens)
        shares.append(theta / np.deg2rad(one.sees_deg))
        places.append(np.where(shares[-1][..., None] <= 1.0, pixels, -1e4))
    return places, shares


def _camera_bearings(width_px: int, orientation: Orientation) -> FloatArray:
    """Bearings (H, W, 3), in the camera's frame, of the pixels of the result."""
    result = EquirectGrid(width_px, width_px // 2)
    robot = result.bearings_from_pixels(pixel_centres(width_px, width_px // 2))
    return np.asarray(robot @ orientation.rotation, dtype=np.float64)


def _fixed_point(u: FloatArray, v: FloatArray) -> tuple[npt.NDArray[np.int16], npt.NDArray[np.uint16]]:
    fixed, fraction = cv2.convertMaps(u.astype(np.float32), v.astype(np.float32), cv2.CV_16SC2)
    return np.asarray(fixed, dtype=np.int16), np.asarray(fraction, dtype=np.uint16)
