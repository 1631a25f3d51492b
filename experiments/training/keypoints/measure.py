"""How many keypoints recur, and what a matcher that knows the truth would answer with SIFT's."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from experiments.rendered.pairs import PosePair
from experiments.training.correspondences import Correspondences, correspondences
from experiments.training.photographing import Conditions, Photographer, draw_apart
from experiments.training.sights import Image, Sight
from experiments.training.worlds import WorldName
from services.features.matching.verification import cues_of
from services.features.networks.runtime import WeightsError
from services.features.pipeline.extraction import extract
from services.features.pipeline.interfaces import FeatureSet, IndexArray, Matched, Profile
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from services.features.pipeline.plugins import PLUGINS
from shared.geometry.sphere import wrap_rad
from shared.geometry.two_view import two_view
from simulator.world.freespace import free_space

BANDS_M = ((0.4, 0.6), (0.9, 1.1), (1.8, 2.2), (2.8, 3.2), (4.6, 5.4))
"""Distances of the pictures: 0.5, 1, 2, 3 and 5 m."""
ELSEWHERE_RAD = 2.0
"""Turn by which keypoints recur by chance alone; chosen: no divisor of a turn, as rooms are square."""
CERTAIN = 0.98
"""What the oracle says of its matches: the largest share of right ones in `nearest_neighbours.RIGHT`."""
ORACLE_ON = "sift"

Row = dict[str, Any]


@dataclass(frozen=True)
class WorldPart:
    """What one process does: pairs of one world.

    Attributes:
        world: a generated one.
        pairs: per band of distances.
        detectors: names for `profile_of`.
        width_px: of the panoramas.
        seed: draws the pairs.
    """

    world: WorldName
    pairs: int
    detectors: tuple[str, ...]
    width_px: int
    seed: int


def profile_of(detector: str) -> Profile:
    """The pipeline whose detector is measured; Key.Net is described by TFeat, whose weights are small.

    Raises:
        ValueError: no such detector.
    """
    if detector == "keynet":
        return Profile("tfeat", detector="keynet")
    if detector not in PLUGINS["extractor"]:
        raise ValueError(
            f"a detector is keynet or an extractor of {sorted(PLUGINS['extractor'])}, got {detector!r}"
        )
    return find_profile(detector)


def measure_world(part: WorldPart) -> list[Row]:
    """A row for each pair and detector; those without weights have none."""
    world = part.world.world()
    photographer, space = Photographer(world, Conditions(), part.width_px), free_space(world)
    rows: list[Row] = []
    for band in BANDS_M:
        rng = np.random.default_rng([part.seed, round(100 * band[0])])
        for _ in range(part.pairs):
            pair = draw_apart(space, rng, band)
            if pair is not None:
                here, there = photographer.sight(pair.current), photographer.sight(pair.target)
                rows += measure_pair(str(part.world), pair, here, there, part.detectors)
    return rows


def measure_pair(
    world: str, pair: PosePair, here: Sight, there: Sight, detectors: Sequence[str]
) -> list[Row]:
    """A row for each detector that can be had."""
    return [
        {"world": world, "distance_m": round(pair.distance_m, 3), "detector": detector}
        | recurrence(first, second, here, there)
        | (answers(first, second, here, there, pair, pipeline) if detector == ORACLE_ON else {})
        for detector, pipeline, first, second in _found(here.picture, there.picture, detectors)
    ]


def recurrence(first: FeatureSet, second: FeatureSet, here: Sight, there: Sight) -> Row:
    """Counts: keypoints, those seen from the other place, those found there, those by chance."""
    truth = correspondences(first.lonlat_rad, second.lonlat_rad, here, there)
    shifted = second.lonlat_rad.astype(np.float64)
    shifted[:, 0] = wrap_rad(shifted[:, 0] + ELSEWHERE_RAD)
    chance = correspondences(first.lonlat_rad, shifted, here, there)
    return {
        "keypoints": len(first),
        "visible": int(truth.visible.sum()),
        "recurring": int(truth.recurring.sum()),
        "by_chance": int(chance.recurring.sum()),
    }


def answers(
    first: FeatureSet, second: FeatureSet, here: Sight, there: Sight, pair: PosePair, pipeline: Pipeline
) -> Row:
    """What the pipeline's own matcher and one that knows the truth lead to."""
    truth = correspondences(first.lonlat_rad, second.lonlat_rad, here, there)
    (matched,) = pipeline.matcher.match(first, [second])
    pairs = truth.pairs
    oracle = Matched(pairs, np.full(len(pairs), CERTAIN))
    return {
        name: answer(first, second, how, truth, pair, pipeline)
        for name, how in (("matcher", matched), ("oracle", oracle))
    }


def answer(
    first: FeatureSet,
    second: FeatureSet,
    matched: Matched,
    truth: Correspondences,
    pair: PosePair,
    pipeline: Pipeline,
) -> Row:
    """Matches, how many are right, how many verified, and how far off the heading is."""
    rows = matched.pairs
    current, target = first.lonlat_rad[rows[:, 0]], second.lonlat_rad[rows[:, 1]]
    rng = np.random.default_rng(len(rows))
    result = two_view(current, target, rng, pipeline.verification, cues_of(first, second, matched))
    off = None if result.heading_rad is None else abs(float(wrap_rad(result.heading_rad - pair.heading_rad)))
    return {
        "matches": len(rows),
        "right": _right(truth, rows),
        "verified": result.inliers if result.usable else 0,
        "verified_right": _right(truth, rows[result.inlier_mask]) if result.usable else 0,
        "possible": len(truth.pairs),
        "answered": result.usable,
        "heading_off_deg": None if off is None else round(float(np.degrees(off)), 3),
    }


def _right(truth: Correspondences, rows: IndexArray) -> int:
    return int(truth.right(rows).sum())


def _found(
    one: Image, other: Image, detectors: Sequence[str]
) -> Iterator[tuple[str, Pipeline, FeatureSet, FeatureSet]]:
    for detector in detectors:
        pipeline = _pipeline(detector)
        if pipeline is not None:
            first, second = (
                extract(picture, pipeline.extractor, pipeline.representation, pipeline.profile)
                for picture in (one, other)
            )
            yield detector, pipeline, first, second


@cache
def _pipeline(detector: str) -> Pipeline | None:
    try:
        return Pipeline(profile_of(detector))
    except WeightsError:
        return None
