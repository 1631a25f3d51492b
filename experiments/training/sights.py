"""A rendered panorama of which everything is known: where it was taken, and how far each pixel is. Pure."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from experiments.photographs.tilting import rotation_of
from shared.geometry.perspective import rotation_z
from shared.geometry.sphere import EquirectGrid, FloatArray, bearings_from_lonlat, lonlat_from_bearings
from simulator.sensors.attitude import PitchRoll

Image = npt.NDArray[np.uint8]
BoolArray = npt.NDArray[np.bool_]

SAME_SHARE, SAME_M = 0.03, 0.03
"""A point is seen where the range measured there is its distance to this: 3 %, or the width of an edge."""
CHECKED = (24, 48)
"""Rows and columns of directions by which overlap is measured: 1152, a share is known to 1.5 points."""
BAND_RAD = float(np.deg2rad(65.0))
"""Latitudes that are looked at (thesis, section 6.1.1)."""


@dataclass(frozen=True)
class CameraPose:
    """Where a camera is, and how it leans.

    Attributes:
        x_m, y_m: on the floor, world frame.
        yaw_rad: heading, world frame.
        height_m: of the camera's centre above the floor.
        tilt: pitch (nose down positive) and roll (left up positive), radians.
    """

    x_m: float
    y_m: float
    yaw_rad: float
    height_m: float
    tilt: PitchRoll = (0.0, 0.0)

    @property
    def position_m(self) -> FloatArray:
        """(3,) centre of the camera, world frame."""
        return np.array([self.x_m, self.y_m, self.height_m])

    @property
    def rotation(self) -> FloatArray:
        """(3, 3) from the camera frame to the world, see `simulator.sensors.attitude`."""
        return rotation_z(self.yaw_rad) @ rotation_of(*self.tilt)


@dataclass(frozen=True, eq=False)
class Sight:
    """One panorama.

    Attributes:
        picture: (H, 2H, 3) BGR, perhaps degraded.
        ranges_m: (H, 2H) metres along the ray of each pixel, inf where nothing is.
        pose: of the camera.
    """

    picture: Image
    ranges_m: npt.NDArray[np.floating]
    pose: CameraPose

    def ranges_at(self, lonlat_rad: npt.ArrayLike) -> FloatArray:
        """(N,) ranges of the pixels that (N, 2) directions fall into, metres; inf where nothing is."""
        row, column = self._pixel(lonlat_rad)
        return np.asarray(self.ranges_m[row, column], np.float64)

    def shows(self, lonlat_rad: npt.ArrayLike, distance_m: FloatArray) -> BoolArray:
        """Whether points at (N, 2) directions and (N,) distances are seen: there or in a pixel beside it."""
        row, column = self._pixel(lonlat_rad)
        height, width = self.ranges_m.shape
        near = np.stack(
            [
                self.ranges_m[np.clip(row + dy, 0, height - 1), (column + dx) % width].astype(np.float64)
                for dy in (-1, 0, 1)
                for dx in (-1, 0, 1)
            ]
        )
        off = np.abs(near - distance_m)
        return np.asarray((off <= np.maximum(SAME_SHARE * distance_m, SAME_M)).any(axis=0))

    def _pixel(self, lonlat_rad: npt.ArrayLike) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        height, width = self.ranges_m.shape
        pixels = EquirectGrid(width, height).pixels_from_lonlat(lonlat_rad)
        row = np.clip(pixels[..., 1].astype(np.intp), 0, height - 1)
        return row, pixels[..., 0].astype(np.intp) % width


def projected(lonlat_rad: npt.ArrayLike, here: Sight, there: Sight) -> tuple[FloatArray, BoolArray]:
    """Where what one panorama shows is in another.

    Args:
        lonlat_rad: (N, 2) directions in `here`, radians.
        here: the panorama in which they are.
        there: the other one.

    Returns:
        (N, 2) directions in `there`, and (N,) whether the point is seen from there; False where `here` shows
        nothing in that direction.
    """
    ranges = here.ranges_at(lonlat_rad)
    rays = bearings_from_lonlat(lonlat_rad) @ here.pose.rotation.T
    known = np.isfinite(ranges)
    points = here.pose.position_m + rays * np.where(known, ranges, 1.0)[:, None]
    seen = (points - there.pose.position_m) @ there.pose.rotation
    lonlat = lonlat_from_bearings(seen)
    visible = known & there.shows(lonlat, np.linalg.norm(seen, axis=-1))
    return lonlat, visible


def overlap(here: Sight, there: Sight) -> float:
    """Share of the directions of `here` within the band, evenly over the sphere, that `there` sees."""
    rows, columns = CHECKED
    heights = np.sin(BAND_RAD) * (2.0 * (np.arange(rows) + 0.5) / rows - 1.0)
    turns = 2.0 * np.pi * (np.arange(columns) + 0.5) / columns - np.pi
    lon, lat = np.meshgrid(turns, np.arcsin(heights))
    _, visible = projected(np.stack([lon.ravel(), lat.ravel()], axis=-1), here, there)
    return float(visible.mean())
