"""Pairs with lines between what is the same, to check them by eye."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from experiments.training.data.shards import Pair
from experiments.training.sights import Image, Sight, projected
from services.launcher.client.failure import ExperimentError
from shared.geometry.sphere import EquirectGrid, FloatArray

LINES, BAND_RAD = 40, 0.9
"""Lines in a pair, and the latitudes from which they start: more hide the pictures; chosen by eye."""
GAP_PX = 6


def draw_pairs(path: Path, pairs: Sequence[Pair], seed: int = 0) -> None:
    """One row for each pair, both panoramas one above the other; a line joins the same point in both.

    Raises:
        ExperimentError: there are no pairs.
    """
    if not pairs:
        raise ExperimentError(f"no pairs to draw into {path}: the worlds have no room for any")
    rng = np.random.default_rng(seed)
    rows = [_drawn(pair, rng) for pair in pairs]
    path.parent.mkdir(parents=True, exist_ok=True)
    if not cv2.imwrite(str(path), np.concatenate(rows)):
        raise OSError(f"{path} could not be written")


def require_picture_name(path: Path) -> None:
    """Refuse a name whose ending says nothing to OpenCV, before hours of work end there.

    Raises:
        ExperimentError: the name does not end as that of a picture does.
    """
    if not cv2.haveImageWriter(str(path)):
        raise ExperimentError(f"a picture's name ends in .png or .jpg, got {path}")


def _drawn(pair: Pair, rng: np.random.Generator) -> Image:
    here, there = pair.here, pair.there
    height, width = here.picture.shape[:2]
    gap = np.full((GAP_PX, width, 3), 255, np.uint8)
    canvas = np.concatenate([here.picture, gap, there.picture, gap])
    start = np.stack([rng.uniform(-np.pi, np.pi, LINES), rng.uniform(-BAND_RAD, BAND_RAD, LINES)], axis=-1)
    end, visible = projected(start, here, there)
    for one, other in zip(_pixels(start[visible], here), _pixels(end[visible], there), strict=True):
        colour = tuple(int(c) for c in rng.integers(64, 256, 3))
        first, second = (round(one[0]), round(one[1])), (round(other[0]), round(other[1]) + height + GAP_PX)
        cv2.line(canvas, first, second, colour, 1, cv2.LINE_AA)
        cv2.circle(canvas, first, 4, colour, 2)
        cv2.circle(canvas, second, 4, colour, 2)
    text = f"{pair.distance_m:.2f} m apart, overlap {pair.overlap[0]:.2f} and {pair.overlap[1]:.2f}"
    cv2.putText(canvas, text, (10, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (255, 255, 255), 3, cv2.LINE_AA)
    cv2.putText(canvas, text, (10, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (0, 0, 0), 1, cv2.LINE_AA)
    return np.asarray(canvas, np.uint8)


def _pixels(lonlat_rad: FloatArray, sight: Sight) -> list[list[float]]:
    height, width = sight.picture.shape[:2]
    pixels: list[list[float]] = EquirectGrid(width, height).pixels_from_lonlat(lonlat_rad).tolist()
    return pixels
