"""The band of a panorama that is looked at: without the poles, where body and distortion are."""

import cv2
import numpy as np

from services.features.pipeline.interfaces import Image
from shared.geometry.sphere import EquirectGrid


def cropped_strip(gray: Image, crop_deg: float, resize: tuple[int, int] | None) -> tuple[Image, EquirectGrid]:
    """Crop a whole panorama above and below, then resize it.

    Args:
        gray: (H, 2H) whole panorama.
        crop_deg: angle cut away on either side, degrees (thesis, section 6.1.1).
        resize: rows and columns of the whole panorama afterwards (thesis, appendix A), None to keep its size.

    Returns:
        The strip and its pixel grid, which gives the true latitudes back.
    """
    height, width = gray.shape[:2]
    grid = EquirectGrid.cropped(width, height, crop_deg)
    strip = gray[grid.row_slice]
    if resize is None or resize == (height, width):
        return np.ascontiguousarray(strip), grid
    rows, columns = resize
    grid = grid.resized(columns, EquirectGrid.cropped(columns, rows, crop_deg).height)
    kind = cv2.INTER_AREA if columns < width else cv2.INTER_LINEAR
    resized = cv2.resize(strip, (columns, grid.height), interpolation=kind)
    return np.asarray(resized, dtype=np.uint8), grid
