"""Perspective (gnomonic) views cut out of the sphere: tangent images, the 90-degree view of thesis 3.1.

The view has its own frame: x into the picture, y left, z up. With f = (W / 2) / tan(fov / 2) pixels,
pixel (u, v) lies at (1, (W/2 - u) / f, (H/2 - v) / f); u grows to the right, so a view at longitude 0,
latitude 0 shows what the centre of the equirectangular image shows.

Tables are for `cv2.remap` with INTER_LINEAR or better and BORDER_WRAP, which joins the columns across the
seam. It would also join the top row to the bottom row, so rows are kept inside the image: what the crop cut
away repeats the last row kept.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import EquirectGrid, FloatArray, lonlat_from_bearings, with_last_axis


def rotation_z(angle_rad: float) -> FloatArray:
    """Rotation about z, (3, 3), counter-clockwise seen from above."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rotation_y(angle_rad: float) -> FloatArray:
    """Rotation about y, (3, 3); a positive angle tips x downwards."""
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


@dataclass(frozen=True)
class PerspectiveView:
    """A pinhole picture of part of the sphere.

    Attributes:
        width: columns, pixels.
        height: rows, pixels.
        fov_rad: horizontal opening, radians, below pi.
        lon_rad: longitude of its centre, radians.
        lat_rad: latitude of its centre, radians.
    """

    width: int
    height: int
    fov_rad: float
    lon_rad: float = 0.0
    lat_rad: float = 0.0

    def __post_init__(self) -> None:
        """Reject a picture that no plane can hold."""
        if self.width < 1 or self.height < 1 or not 0.0 < self.fov_rad < np.pi:
            raise ValueError(
                "a view needs width and height of at least 1 and 0 < fov_rad < pi, "
                f"got {self.width} x {self.height} and {self.fov_rad}"
            )

    @property
    def focal_px(self) -> float:
        """Focal length, pixels."""
        return self.width / 2.0 / float(np.tan(self.fov_rad / 2.0))

    @property
    def rotation(self) -> FloatArray:
        """R_camera_view (3, 3): maps view-frame bearings to the camera frame."""
        return rotation_z(self.lon_rad) @ rotation_y(-self.lat_rad)

    def bearings_from_pixels(self, pixels: npt.ArrayLike) -> FloatArray:
        """Map (..., 2) pixels (u, v) of the view to (..., 3) unit bearings in the camera frame."""
        uv = with_last_axis("pixels", pixels, 2)
        y = (self.width / 2.0 - uv[..., 0]) / self.focal_px
        z = (self.height / 2.0 - uv[..., 1]) / self.focal_px
        ray = np.stack([np.ones_like(y), y, z], axis=-1) @ self.rotation.T
        return np.asarray(ray / np.linalg.norm(ray, axis=-1, keepdims=True), dtype=np.float64)

    def lonlat_from_pixels(self, pixels: npt.ArrayLike) -> FloatArray:
        """Map (..., 2) pixels of the view to (..., 2) longitude, latitude (rad) in the camera frame."""
        return lonlat_from_bearings(self.bearings_from_pixels(pixels))

    def pixels_from_bearings(self, bearings: npt.ArrayLike) -> FloatArray:
        """Map (..., 3) camera-frame bearings to (..., 2) pixels; NaN for what lies behind the view."""
        local = with_last_axis("bearings", bearings, 3) @ self.rotation
        depth = np.where(local[..., 0] > 1e-12, local[..., 0], np.nan)
        u = self.width / 2.0 - self.focal_px * local[..., 1] / depth
        v = self.height / 2.0 - self.focal_px * local[..., 2] / depth
        return np.stack([u, v], axis=-1)


class RemapTable(NamedTuple):
    """Where each output pixel (H, W) comes from.

    Attributes:
        map_x: (H, W) float32 source column, in OpenCV's count (0 is the centre of the first pixel).
        map_y: (H, W) float32 source row, the same count, clamped to the image.
    """

    map_x: npt.NDArray[np.float32]
    map_y: npt.NDArray[np.float32]


def view_table(view: PerspectiveView, source: EquirectGrid) -> RemapTable:
    """Table that renders a perspective view from an equirectangular image."""
    centres = pixel_centres(view.width, view.height)
    pixels = source.pixels_from_bearings(view.bearings_from_pixels(centres)) - 0.5
    rows = np.clip(pixels[..., 1], 0.0, source.height - 1.0)
    return RemapTable(pixels[..., 0].astype(np.float32), rows.astype(np.float32))


def pixel_centres(width: int, height: int) -> FloatArray:
    """Continuous coordinates (H, W, 2) of all pixel centres of a picture, pixels."""
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return np.stack([u, v], axis=-1)
