"""Resampling tables for the sphere, for `cv2.remap` with INTER_LINEAR or better and BORDER_WRAP.

BORDER_WRAP joins the columns across the seam. It would also join the top row to the bottom row, so map_y is
kept inside the image; what the crop cut away is told by `inside` and must be blanked by the caller.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from shared.geometry.angles import FloatArray
from shared.geometry.perspective import PerspectiveView
from shared.geometry.sphere import EquirectGrid


class RemapTable(NamedTuple):
    """Where each output pixel (H, W) comes from.

    Attributes:
        map_x: (H, W) float32 source column, in OpenCV's count (0 is the centre of the first pixel).
        map_y: (H, W) float32 source row, the same count, clamped to the image.
        inside: (H, W) whether the source row lies in the image.
    """

    map_x: npt.NDArray[np.float32]
    map_y: npt.NDArray[np.float32]
    inside: npt.NDArray[np.bool_]


def view_table(view: PerspectiveView, source: EquirectGrid) -> RemapTable:
    """Table that renders a perspective view from an equirectangular image."""
    return _table(view.bearings_from_pixels(pixel_centres(view.width, view.height)), source)


def rotation_table(output: EquirectGrid, source: EquirectGrid, rotation: FloatArray) -> RemapTable:
    """Table that renders an equirectangular image seen by a turned camera.

    Args:
        output: grid of the picture to make.
        source: grid of the picture at hand.
        rotation: R_source_output (3, 3), maps bearings of the output camera to those of the source camera.
    """
    bearings = output.bearings_from_pixels(pixel_centres(output.width, output.height))
    return _table(bearings @ np.asarray(rotation, dtype=np.float64).T, source)


def pixel_centres(width: int, height: int) -> FloatArray:
    """Continuous coordinates (H, W, 2) of all pixel centres of a picture."""
    u, v = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return np.stack([u, v], axis=-1)


def _table(bearings: FloatArray, source: EquirectGrid) -> RemapTable:
    pixels = source.pixels_from_bearings(bearings)
    row = np.clip(pixels[..., 1] - 0.5, 0.0, source.height - 1.0)
    return RemapTable(
        (pixels[..., 0] - 0.5).astype(np.float32), row.astype(np.float32), source.contains_pixels(pixels)
    )
