"""One pair of canvases with one combination of plugins: matches, labels, average precision."""

import time
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from experiments.matching.placing import (
    Change,
    Image,
    changed_picture,
    placed,
    rectified,
    similarity_of,
    view_of,
)
from experiments.matching.precision import Curve, curve_of
from services.features.matching.nearest_neighbours import find_neighbours
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import Distance, FeatureSet, Representation, View
from services.features.pipeline.pipeline import Pipeline
from shared.geometry.sphere import FloatArray

BORDER_PX = 6.0
"""Keypoints this near the picture's edge are found because of the edge (thesis 3.1)."""
CORRECT_PX = RANSAC_PX = 3.0
"""A match lies where the known map or the homography says: OpenCV's usual threshold of reprojection."""


@dataclass(frozen=True, eq=False)
class PairResult:
    """What one pair gave.

    Attributes:
        known: curve with labels by the known map between the pictures.
        ransac: curve with labels by a homography found by RANSAC, as in the thesis.
        agreement: share of matches that both label alike; 1 where there are none.
        keypoints: smaller count of both pictures.
        time_s: extraction of both and matching.
    """

    known: Curve
    ransac: Curve
    agreement: float
    keypoints: int
    time_s: float


class OnlyFilled:
    """A representation without the views that show nothing: most faces of a canvas are black."""

    def __init__(self, inner: Representation) -> None:
        self._inner = inner

    def views(self, gray: Image) -> list[View]:
        """Views with any light in them, at least one."""
        views = self._inner.views(gray)
        return [view for view in views if view.gray.any()] or views[:1]


@dataclass(frozen=True, eq=False)
class Placed:
    """Features of one placed picture.

    Attributes:
        features: those inside the picture.
        pixels: (N, 2) where they lie in it.
        side_px: its size.
        change: what was done to it.
        time_s: what their extraction took.
    """

    features: FeatureSet
    pixels: FloatArray
    side_px: int
    change: Change
    time_s: float


def measure_pair(first: Placed, second: Placed, distance: Distance, matcher: str) -> PairResult:
    """Match a picture at the middle of the canvas with its changed copy elsewhere.

    Args:
        first: the unchanged picture at the middle.
        second: the copy.
        distance: of the descriptors.
        matcher: brute_force or mutual_ratio.
    """
    begin = time.perf_counter()
    pairs, order = _matched(first.features, second.features, distance, matcher)
    spent = time.perf_counter() - begin + first.time_s + second.time_s
    here, there = first.pixels[pairs[:, 0]], second.pixels[pairs[:, 1]]
    expected = _mapped(here, similarity_of(second.change, first.side_px))
    known = np.linalg.norm(expected - there, axis=1) < CORRECT_PX
    by_ransac = _ransac(here, there)
    count = min(len(first.features), len(second.features))
    agreement = float(np.mean(known == by_ransac)) if len(pairs) else 1.0
    return PairResult(
        curve_of(order, known, count), curve_of(order, by_ransac, count), agreement, count, spent
    )


def extracted(picture: Image, change: Change, pipeline: Pipeline, canvas_px: int) -> Placed:
    """Change a picture (S, S), place it on a canvas, extract: features inside it, away from its edges."""
    changed, shown = changed_picture(picture, change)
    view = view_of(change, len(picture))
    canvas = placed(changed, view, canvas_px)
    begin = time.perf_counter()
    found = extract(canvas, pipeline.extractor, OnlyFilled(pipeline.representation), pipeline.profile)
    spent = time.perf_counter() - begin
    pixels = rectified(found.lonlat_rad, view)
    inner = cv2.erode(np.pad(shown, 1).astype(np.uint8), np.ones((3, 3)), iterations=int(BORDER_PX))[
        1:-1, 1:-1
    ]
    inside = np.isfinite(pixels).all(axis=1)
    column, row = (np.clip(np.nan_to_num(pixels[:, k]), 0, len(picture) - 1).astype(int) for k in (0, 1))
    inside &= (np.abs(pixels - len(picture) / 2.0) < len(picture) / 2.0 - BORDER_PX).all(axis=1)
    keep = np.flatnonzero(inside & (inner[row, column] > 0))
    kept = FeatureSet(found.lonlat_rad[keep], found.scores[keep], found.descriptors[keep])
    return Placed(kept, pixels[keep], len(picture), change, spent)


def _matched(
    first: FeatureSet, second: FeatureSet, kind: Distance, matcher: str
) -> tuple[npt.NDArray[np.intp], FloatArray]:
    """Pairs and what orders them: the distance, or its ratio to the second for mutual neighbours."""
    (found,) = find_neighbours(first.descriptors, [second.descriptors], kind)
    if found is None:
        return np.zeros((0, 2), np.intp), np.zeros(0)
    rows = np.arange(len(first))
    if matcher == "brute_force":
        return np.stack([rows, found.nearest], axis=1), found.first.astype(np.float64)
    rows = rows[found.mutual]
    ratio = found.first[rows] / np.maximum(found.second[rows], 1e-9)
    return np.stack([rows, found.nearest[rows]], axis=1), ratio.astype(np.float64)


def _mapped(pixels: FloatArray, matrix: FloatArray) -> FloatArray:
    return np.asarray(pixels @ matrix[:, :2].T + matrix[:, 2], np.float64)


def _ransac(first: FloatArray, second: FloatArray) -> npt.NDArray[np.bool_]:
    if len(first) < 4:
        return np.zeros(len(first), np.bool_)
    cv2.setRNGSeed(1)
    _, mask = cv2.findHomography(first.astype(np.float32), second.astype(np.float32), cv2.RANSAC, RANSAC_PX)
    return np.zeros(len(first), np.bool_) if mask is None else mask.ravel().astype(np.bool_)
