"""How much of the sphere a camera's panoramas show, and whether their edges meet. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Image = npt.NDArray[np.uint8]
Mask = npt.NDArray[np.bool_]

BLACK = 20
"""Brightest level, of 255, of a part without a picture; chosen: video writes black as 16, JPEG blurs it."""
NEEDED_RAD = math.radians(55.0)
"""Features are looked for up to here above and below the horizon (crop_deg of the pipelines)."""
BESIDE_PX = 4
"""How far beside a seam it is compared with; chosen: beyond what blurs it."""
ROWS_RAD = math.radians(60.0)
"""Rows in which seams are looked at; further up and down columns crowd."""


@dataclass(frozen=True)
class Coverage:
    """What is seen.

    Attributes:
        lowest_rad, highest_rad: latitudes between which there is a picture, positive above the horizon.
        blank_share: share of the band that features need in which there is none.
    """

    lowest_rad: float
    highest_rad: float
    blank_share: float


def coverage_of(panoramas: Sequence[Image]) -> Coverage:
    """What at least one of several panoramas, each (H, 2H, 3), shows: what is always black is no picture.

    Returns:
        The coverage; all blank and from 0 to 0 where nothing is seen at the horizon.
    """
    brightest = np.max([panorama.max(axis=2) for panorama in panoramas], axis=0)
    blank = brightest <= BLACK
    height = len(blank)
    latitudes = math.pi * (0.5 - (np.arange(height) + 0.5) / height)
    seen = blank.mean(axis=1) < 0.5
    needed = np.abs(latitudes) <= NEEDED_RAD
    weights = np.cos(latitudes[needed])
    share = float(np.average(blank[needed].mean(axis=1), weights=weights))
    middle = height // 2
    if not seen[middle]:
        return Coverage(0.0, 0.0, share)
    above, below = (np.flatnonzero(~part) for part in (seen[:middle][::-1], seen[middle:]))
    top = int(above[0]) if len(above) else middle
    bottom = int(below[0]) if len(below) else height - middle
    return Coverage(-math.pi * bottom / height, math.pi * top / height, share)


def ends(panorama: Image) -> Mask:
    """The seam (H, W) of a panorama: pixels whose right neighbour is that of the other end."""
    found = np.zeros(panorama.shape[:2], dtype=np.bool_)
    found[:, -1] = True
    return found


def joins(sides: Mask) -> Mask:
    """The seam (H, W) of two lenses: pixels whose right neighbour is the other's, by who sees what (H, W)."""
    return np.asarray(sides != np.roll(sides, -1, axis=1), dtype=np.bool_)


def jump(panorama: Image, seam: Mask) -> float:
    """How much more the picture changes across a seam than beside it: about 1 where it is seamless.

    Args:
        panorama: (H, 2H, 3).
        seam: (H, 2H), as from `ends` or `joins`.
    """
    change = np.abs(panorama.astype(np.int16) - np.roll(panorama, -1, axis=1)).mean(axis=2)
    height = len(panorama)
    rows = slice(round(height * (0.5 - ROWS_RAD / math.pi)), round(height * (0.5 + ROWS_RAD / math.pi)))
    change, seam = change[rows], seam[rows]
    if not seam.any():
        return 1.0
    shifts = [sign * BESIDE_PX * far for sign in (-1, 1) for far in (1, 2, 3)]
    beside = np.mean([change[np.roll(seam, shift, axis=1)].mean() for shift in shifts])
    return float(change[seam].mean() / max(float(beside), 1.0))
