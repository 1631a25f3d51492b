"""Pairs of patches that show the same point of a world, from two panoramas of which all ranges are known."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Self

import cv2
import numpy as np
import numpy.typing as npt
from pydantic import Field, NonNegativeFloat, NonNegativeInt, PositiveInt

from experiments.training.data.shards import Pair
from experiments.training.patch.cutting import (
    COARSEST,
    FINEST,
    HALF_PX,
    PATCH_PX,
    STEP,
    Frames,
    corners,
    patches,
)
from experiments.training.recipe import Recipe
from experiments.training.sights import Sight, projected
from services.features.pipeline.interfaces import FloatArray, Image, IndexArray, Profile
from services.features.representations.equirectangular import PAD_COLUMNS
from services.features.representations.strip import cropped_strip
from shared.geometry.sphere import EquirectGrid, bearings_from_lonlat

LEAST_PX, MOST_PX = HALF_PX * STEP ** (FINEST - 1), HALF_PX * STEP ** (COARSEST + 1)
"""Half sides that a partner may have: one level more at either end than the detector looks at."""
PADDING = np.array([PAD_COLUMNS, 0.0])
VIEW = Profile("patches")
"""Cropped and resized as for every extractor."""


class Sampling(Recipe):
    """How patches are drawn from pairs of panoramas.

    Attributes:
        seed: of every draw.
        keypoints: corners of a picture, the strongest: thrice as many as a robot keeps, as it looks for.
        per_pair: most pairs of patches from a pair of panoramas.
        most: pairs of patches in all, 2 kB each: bounds the memory.
        offset: 1 sigma of where the partner's centre is, in half sides: one pixel of a patch is 0.06.
        octaves: 1 sigma of the partner's size: half of what is between two levels of the detector.
        turn_rad: 1 sigma of its turn: 3 degrees, beside what leaning cameras do.
    """

    seed: NonNegativeInt = 1
    keypoints: PositiveInt = 900
    per_pair: PositiveInt = 2000
    most: PositiveInt = 1_000_000
    offset: NonNegativeFloat = Field(default=0.06, le=1.0)
    octaves: NonNegativeFloat = Field(default=0.25, le=2.0)
    turn_rad: NonNegativeFloat = 0.05


@dataclass(frozen=True, eq=False)
class Patches:
    """N pairs of patches; those of one pair of panoramas follow one another.

    Attributes:
        pictures: (N, 2, 32, 32) grey, one from each panorama.
        panoramas: (N,) number of the pair of panoramas, rising.
        worlds: (N,) number of the world.
        points_m: (N, 3) what is shown, world frame.
        ranges_m: (N,) how far that is from the camera whose corner it was.
        bearings: (N, 2, 3) where it is in both panoramas, camera frames.
    """

    pictures: npt.NDArray[np.uint8]
    panoramas: npt.NDArray[np.int32]
    worlds: npt.NDArray[np.int32]
    points_m: npt.NDArray[np.float32]
    ranges_m: npt.NDArray[np.float32]
    bearings: npt.NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.panoramas)

    def __getitem__(self, rows: IndexArray | slice) -> Self:
        return type(self)(*(getattr(self, field.name)[rows] for field in fields(self)))

    @cached_property
    def begins(self) -> IndexArray:
        """First row of each pair of panoramas."""
        return np.flatnonzero(np.diff(self.panoramas, prepend=-1))

    def put(self, begin: int, part: "Patches") -> int:
        """Put others in place from row `begin` on; returns the row after them."""
        end = begin + len(part)
        for field in fields(self):
            getattr(self, field.name)[begin:end] = getattr(part, field.name)
        return end

    @classmethod
    def empty(cls, count: int) -> Self:
        """Room for so many, which takes memory where something is put."""
        return cls(
            np.empty((count, 2, PATCH_PX, PATCH_PX), np.uint8),
            np.empty(count, np.int32),
            np.empty(count, np.int32),
            np.empty((count, 3), np.float32),
            np.empty(count, np.float32),
            np.empty((count, 2, 3), np.float32),
        )


def joined(parts: Sequence[Patches]) -> Patches:
    """All of them."""
    whole, end = Patches.empty(sum(map(len, parts))), 0
    for part in parts:
        end = whole.put(end, part)
    return whole


def patches_of(pair: Pair, recipe: Sampling, count: int, rng: np.random.Generator) -> Patches:
    """At most `count` pairs of patches: corners of either panorama, and where they are in the other.

    The other one need not be a corner there: what recurs is learned as it would look if it were found.
    Panoramas and worlds are numbered 0.
    """
    first, second = _Looked.at(pair.here, recipe.keypoints), _Looked.at(pair.there, recipe.keypoints)
    forth = _partners(first, second, recipe, (count + 1) // 2, rng)
    back = _partners(second, first, recipe, count // 2, rng)
    for both in (back.pictures, back.bearings):
        both[:] = both[:, ::-1].copy()
    return joined([forth, back])


@dataclass(frozen=True, eq=False)
class _Looked:
    """A panorama as the feature service sees it: its strip, continued beyond the seam, and its corners."""

    sight: Sight
    gray: Image
    grid: EquirectGrid
    frames: Frames

    @classmethod
    def at(cls, sight: Sight, keypoints: int) -> "_Looked":
        gray = np.asarray(cv2.cvtColor(sight.picture, cv2.COLOR_BGR2GRAY), np.uint8)
        strip, grid = cropped_strip(gray, VIEW.crop_deg, VIEW.resize)
        wide = cv2.copyMakeBorder(strip, 0, 0, PAD_COLUMNS, PAD_COLUMNS, cv2.BORDER_WRAP)
        gray = np.asarray(wide, np.uint8)
        found = corners(gray, keypoints)
        column = found.pixels[:, 0] - PAD_COLUMNS
        return cls(sight, gray, grid, found[(column >= 0.0) & (column < grid.width)])

    def lonlat(self) -> FloatArray:
        return self.grid.lonlat_from_pixels(self.frames.pixels - PADDING)

    def pixels(self, lonlat_rad: FloatArray) -> FloatArray:
        return np.asarray(self.grid.pixels_from_lonlat(lonlat_rad) + PADDING)


def _partners(
    here: _Looked, there: _Looked, recipe: Sampling, count: int, rng: np.random.Generator
) -> Patches:
    """Corners of one panorama and their places in the other, at most `count`, drawn evenly."""
    lonlat = here.lonlat()
    expected, visible = projected(lonlat, here.sight, there.sight)
    own = bearings_from_lonlat(lonlat)
    ranges = here.sight.ranges_at(lonlat)
    near = np.where(visible, ranges, 1.0)
    points = here.sight.pose.position_m + near[:, None] * (own @ here.sight.pose.rotation.T)
    away = np.linalg.norm(points - there.sight.pose.position_m, axis=-1)
    off = rng.normal(size=(len(own), 4))  # drawn for all: what one corner gets depends on no other
    halves = here.frames.halves_px * near / np.maximum(away, 1e-6) * 2.0 ** (recipe.octaves * off[:, 0])
    pixels = there.pixels(expected)
    fit = visible & (halves >= LEAST_PX) & (halves <= MOST_PX)
    fit &= (pixels[:, 1] >= 0.0) & (pixels[:, 1] < there.gray.shape[0])
    rows = np.sort(rng.permutation(np.flatnonzero(fit))[:count])
    placed = pixels[rows] + recipe.offset * halves[rows, None] * off[rows, 1:3]
    pictures = (
        patches(here.gray, here.frames[rows]),
        patches(there.gray, Frames(placed, halves[rows]), recipe.turn_rad * off[rows, 3]),
    )
    zeros = np.zeros(len(rows), np.int32)
    return Patches(
        np.stack(pictures, axis=1),
        zeros,
        zeros.copy(),
        points[rows].astype(np.float32),
        near[rows].astype(np.float32),
        np.stack([own[rows], bearings_from_lonlat(expected[rows])], axis=1).astype(np.float32),
    )
