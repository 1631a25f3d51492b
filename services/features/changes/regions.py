"""Connected regions of a band of the sphere in which much is unexplained. Pure."""

import math

import cv2
import numpy as np
import numpy.typing as npt

from services.features.changes.search import Map
from shared.geometry.sphere import EquirectGrid
from shared.messages.inspections import Region

MOST = 32
"""Regions of one picture, the most significant; chosen: more say that it is another place."""


def regions(share: Map, first_row: int, least_share: float, least_sr: float) -> list[Region]:
    """Regions by significance, the most significant first.

    Args:
        share: (rows, W) of what is not alike, 0 to 1; the band of an equirectangular picture of width W.
        first_row: of the band in that picture.
        least_share: from which on a patch counts.
        least_sr: smaller regions do not count, steradians.
    """
    height, width = share.shape
    grid = EquirectGrid(width, width // 2)
    counts = share > least_share
    free = int(np.argmin(counts.sum(axis=0)))  # the band is cut where nothing, or least, is cut in two
    turned = np.roll(share, -free, axis=1)
    count, labels = cv2.connectedComponents(np.roll(counts, -free, axis=1).astype(np.uint8), connectivity=8)
    latitude_rad = math.pi / 2 - math.pi * (np.arange(height) + first_row + 0.5) / (width // 2)
    pixel_sr = np.cos(latitude_rad) * math.tau / width * math.pi / (width // 2)
    found = []
    for label in range(1, count):
        row, column = np.nonzero(labels == label)
        size_sr = float(pixel_sr[row].sum())
        if size_sr >= least_sr:
            excess = turned[row, column] - least_share
            found.append(_region(row + first_row, column + free, float(excess @ pixel_sr[row]), grid))
    return sorted(found, key=lambda each: -each.score)[:MOST]


def _region(
    row: npt.NDArray[np.intp],
    column: npt.NDArray[np.intp],
    score: float,
    grid: EquirectGrid,
) -> Region:
    middle = np.array([column.min() + column.max() + 1, row.min() + row.max() + 1]) / 2
    longitude_rad, latitude_rad = grid.lonlat_from_pixels(np.array([middle[0] % grid.width, middle[1]]))
    per_px = math.tau / grid.width
    return Region(
        bearing_rad=float(longitude_rad),
        elevation_rad=float(latitude_rad),
        width_rad=float(np.ptp(column) + 1) * per_px,
        height_rad=float(np.ptp(row) + 1) * per_px,
        score=score,
    )
