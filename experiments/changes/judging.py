"""Reported regions against what really changed. Pure.

A region is true if its middle lies on a change, or near it. It reports the change that it lies on, and those
of which its box, which people are shown, holds most: two chairs that were moved side by side are one region.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from experiments.changes.sights import Labels
from services.features.changes.comparison import BAND_RAD
from shared.geometry.sphere import EquirectGrid
from shared.messages.inspections import Region

MARGIN_RAD = math.radians(5.0)
"""Round what changed: from where the other picture was taken it stood that much elsewhere."""
IN_SIGHT_SR = 0.005
"""Of a change that can be asked for; chosen: 4 by 4 degrees, a basket 3 m away."""
LEAST_HELD = 0.5
"""Of a change, in the box of a region that reports it."""
LEAST_TRUE = 0.5
"""Of that box, on something that changed, margins included: a box round everything reports nothing."""

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Verdict:
    """Of one pair of pictures.

    Attributes:
        sizes_sr: of each change in sight its solid angle, by its number from 1.
        by_number: whether a region reports it.
        false: regions where nothing changed.
    """

    sizes_sr: dict[int, float]
    by_number: dict[int, bool]
    false: tuple[Region, ...]


class Truth:
    """What really changed in a picture, asked often.

    Args:
        labels: (H, 2 H), k for the k-th alteration, see `sights`.
        alterations: how many there were.
    """

    def __init__(self, labels: Labels, alterations: int) -> None:
        self._grid = EquirectGrid(labels.shape[1], labels.shape[0])
        self._explained = _grown(labels > 0)
        changed = {number: labels == number for number in range(1, alterations + 1)}
        sizes = {number: _solid_angle_sr(mask) for number, mask in changed.items()}
        self._sizes_sr = {number: size for number, size in sizes.items() if size >= IN_SIGHT_SR}
        self._changed = {number: changed[number] for number in self._sizes_sr}
        self._masks = {number: _grown(changed[number]) for number in self._sizes_sr}

    def judge(self, reported: Sequence[Region]) -> Verdict:
        """Hold regions against it."""
        centres = np.array([(each.bearing_rad, each.elevation_rad) for each in reported]).reshape(-1, 2)
        at = np.floor(self._grid.pixels_from_lonlat(centres)).astype(int)
        column, row = at[:, 0] % self._grid.width, np.clip(at[:, 1], 0, self._grid.height - 1)
        known = self._explained[row, column]
        boxes = [self._box(each) for each, true in zip(reported, known, strict=True) if true]
        telling = [box for box in boxes if self._explained[box].mean() >= LEAST_TRUE]
        by_number = {
            number: bool(mask[row, column].any())
            or any(
                self._changed[number][box].sum() >= LEAST_HELD * self._changed[number].sum()
                for box in telling
            )
            for number, mask in self._masks.items()
        }
        false = tuple(each for each, true in zip(reported, known, strict=True) if not true)
        return Verdict(self._sizes_sr, by_number, false)

    def _box(self, region: Region) -> tuple[npt.NDArray[np.intp], ...]:
        """Rows and columns of a region's box, across the seam, to index a picture with."""
        middle = np.array([(region.bearing_rad, region.elevation_rad)])
        (x, y), per_rad = self._grid.pixels_from_lonlat(middle)[0], self._grid.width / math.tau
        wide, high = region.width_rad * per_rad / 2, region.height_rad * per_rad / 2
        rows = np.arange(
            max(0, round(y - high)), min(self._grid.height, max(round(y + high), round(y - high) + 1))
        )
        columns = np.arange(round(x - wide), max(round(x + wide), round(x - wide) + 1)) % self._grid.width
        return np.ix_(rows, columns)


def _grown(mask: Mask) -> Mask:
    """With a margin, across the seam."""
    width = mask.shape[1]
    reach_px = round(MARGIN_RAD / math.tau * width)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach_px + 1, 2 * reach_px + 1))
    wide = np.concatenate([mask[:, -reach_px:], mask, mask[:, :reach_px]], axis=1).astype(np.uint8)
    return np.asarray(cv2.dilate(wide, disc)[:, reach_px:-reach_px] > 0)


def _solid_angle_sr(mask: Mask) -> float:
    """Of what lies in the band that is compared."""
    height, width = mask.shape
    latitude_rad = math.pi / 2 - math.pi * (np.arange(height) + 0.5) / height
    weight = np.cos(latitude_rad) * (np.abs(latitude_rad) < BAND_RAD)
    return float((mask.sum(axis=1) * weight).sum() * math.tau / width * math.pi / height)
