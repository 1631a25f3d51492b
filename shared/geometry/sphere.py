"""Equirectangular image <-> longitude, latitude <-> unit bearing (conventions: package docstring).

Equations, for a full image of W columns and H rows with `crop_top` rows cut away above
    (1)  lon = 2 pi (1/2 - u / W)              lat = pi (1/2 - (v + crop_top) / H)
    (2)  b   = (cos lat cos lon, cos lat sin lon, sin lat)
    (3)  lon = atan2(b_y, b_x)                 lat = atan2(b_z, hypot(b_x, b_y))
    (4)  u   = W (1/2 - lon / 2 pi) mod W      v   = H (1/2 - lat / pi) - crop_top
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.intp]


def wrap_rad(angle_rad: npt.ArrayLike) -> FloatArray:
    """Wrap angles of any shape to [-pi, pi), radians."""
    angle = np.asarray(angle_rad, dtype=np.float64)
    wrapped = np.mod(angle + np.pi, 2.0 * np.pi) - np.pi
    # The modulo of a tiny negative number rounds up to the modulus: keep the interval half open.
    return np.asarray(np.where(wrapped >= np.pi, -np.pi, wrapped), dtype=np.float64)


def bearings_from_lonlat(lonlat_rad: npt.ArrayLike) -> FloatArray:
    """Map (..., 2) longitude, latitude (rad) to (..., 3) unit bearings, equation (2)."""
    lonlat = with_last_axis("lonlat_rad", lonlat_rad, 2)
    lon, lat = lonlat[..., 0], lonlat[..., 1]
    return np.stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)], axis=-1)


def lonlat_from_bearings(bearings: npt.ArrayLike) -> FloatArray:
    """Map (..., 3) bearings of any non-zero length to (..., 2) longitude, latitude (rad), equation (3)."""
    b = with_last_axis("bearings", bearings, 3)
    lon = wrap_rad(np.arctan2(b[..., 1], b[..., 0]))
    lat = np.arctan2(b[..., 2], np.hypot(b[..., 0], b[..., 1]))  # arcsin loses precision at the poles
    return np.stack([lon, lat], axis=-1)


def angle_between_rad(a: npt.ArrayLike, b: npt.ArrayLike) -> FloatArray:
    """Angle between (..., 3) bearings, radians in [0, pi]; exact for tiny angles, where arccos is not."""
    a3, b3 = with_last_axis("a", a, 3), with_last_axis("b", b, 3)
    cross = np.linalg.norm(np.cross(a3, b3), axis=-1)
    return np.asarray(np.arctan2(cross, np.sum(a3 * b3, axis=-1)), dtype=np.float64)


@dataclass(frozen=True)
class EquirectGrid:
    """Pixel grid of an equirectangular image, possibly cropped above and below, possibly resized.

    Rows may be fractional: cropping a whole number of rows and then resizing leaves a crop that is not whole.

    Attributes:
        width: columns, covering the full turn, pixels.
        full_height: rows the image would have from pole to pole, pixels.
        crop_top: rows cut away above, pixels.
        crop_bottom: rows cut away below, pixels.
    """

    width: int
    full_height: float
    crop_top: float = 0.0
    crop_bottom: float = 0.0

    def __post_init__(self) -> None:
        """Reject a grid without pixels."""
        if self.width < 1 or self.full_height <= 0.0:
            raise ValueError(
                f"width and full_height must be positive, got {self.width} and {self.full_height}"
            )
        if self.crop_top < 0.0 or self.crop_bottom < 0.0 or self.height < 1:
            raise ValueError(
                f"crop must leave at least one of {self.full_height} rows, "
                f"got crop_top {self.crop_top} and crop_bottom {self.crop_bottom}"
            )

    @classmethod
    def cropped(cls, width: int, full_height: int, crop_deg: float) -> "EquirectGrid":
        """Grid with `crop_deg` degrees cut away at the top and again at the bottom (thesis: 25).

        The rows are rounded to whole ones: 142 of 1024, 56 of 400 for 25 degrees.
        """
        rows = float(np.floor(full_height * crop_deg / 180.0 + 0.5))
        return cls(width, full_height, rows, rows)

    @property
    def height(self) -> int:
        """Rows present in the image, pixels."""
        return round(self.full_height - self.crop_top - self.crop_bottom)

    @property
    def row_slice(self) -> slice:
        """Rows of the full image that this grid keeps; valid while the grid has not been resized."""
        return slice(round(self.crop_top), round(self.crop_top) + self.height)

    def resized(self, width: int, height: int) -> "EquirectGrid":
        """Grid after the (cropped) image is resized to width x height pixels, whatever the aspect."""
        scale = height / (self.full_height - self.crop_top - self.crop_bottom)
        return EquirectGrid(width, self.full_height * scale, self.crop_top * scale, self.crop_bottom * scale)

    def lonlat_from_pixels(self, pixels: npt.ArrayLike) -> FloatArray:
        """Map (..., 2) pixels (u, v) to (..., 2) longitude, latitude (rad), equation (1); u wraps."""
        uv = with_last_axis("pixels", pixels, 2)
        lon = wrap_rad(2.0 * np.pi * (0.5 - uv[..., 0] / self.width))
        lat = np.pi * (0.5 - (uv[..., 1] + self.crop_top) / self.full_height)
        return np.stack([lon, lat], axis=-1)

    def pixels_from_lonlat(self, lonlat_rad: npt.ArrayLike) -> FloatArray:
        """Map (..., 2) longitude, latitude (rad) to (..., 2) pixels, equation (4); v may leave the crop."""
        lonlat = with_last_axis("lonlat_rad", lonlat_rad, 2)
        u = np.mod(self.width * (0.5 - lonlat[..., 0] / (2.0 * np.pi)), self.width)
        v = self.full_height * (0.5 - lonlat[..., 1] / np.pi) - self.crop_top
        return np.stack([u, v], axis=-1)

    def bearings_from_pixels(self, pixels: npt.ArrayLike) -> FloatArray:
        """Map (..., 2) pixels to (..., 3) unit bearings."""
        return bearings_from_lonlat(self.lonlat_from_pixels(pixels))

    def pixels_from_bearings(self, bearings: npt.ArrayLike) -> FloatArray:
        """Map (..., 3) bearings of any non-zero length to (..., 2) pixels."""
        return self.pixels_from_lonlat(lonlat_from_bearings(bearings))


def with_last_axis(name: str, array: npt.ArrayLike, size: int) -> FloatArray:
    """Return the array as float64 if its last axis has the given size, else say what it has."""
    values = np.asarray(array, dtype=np.float64)
    if values.shape[-1:] != (size,):
        raise ValueError(f"{name} must have shape (..., {size}), got {values.shape}")
    return values
