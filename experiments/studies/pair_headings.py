"""Headings by all seven methods from the same matches of one pose pair. Pure.

Uses the pure code of `services.features` (matching, verification limits) and `services.planner.heading`.
"""

from dataclasses import dataclass

import numpy as np

from experiments.studies.pair_features import FeaturePair
from experiments.studies.pairs import PosePair
from services.features.pipeline.pipeline import Pipeline
from services.planner.heading.methods import heading_estimate
from shared.geometry.two_view import TwoViewResult, two_view

METHODS = ("epipolar", "1", "2", "3", "4", "5", "6")


@dataclass(frozen=True)
class PairResult:
    """One pair.

    Attributes:
        raw, verified: number of matches before and after verification.
        disparity_rad: median change of bearing after yaw; None where there is no yaw.
        verified_errors_rad: heading error by method, from verified matches; None where it gave no heading.
        raw_errors_rad: the same from all matches; epipolar is the same in both.
        yaw_error_rad: None where there is no yaw.
    """

    distance_m: float
    raw: int
    verified: int
    status: str
    confidence: float
    disparity_rad: float | None
    yaw_error_rad: float | None
    verified_errors_rad: dict[str, float | None]
    raw_errors_rad: dict[str, float | None]


def judge_pair(pair: PosePair, features: FeaturePair, pipeline: Pipeline, seed: int) -> PairResult:
    """Match, verify, and compare every method's heading with the truth; `seed` draws the hypotheses."""
    (rows,) = pipeline.matcher.match(features[0], [features[1]])
    current, target = features[0].lonlat_rad[rows[:, 0]], features[1].lonlat_rad[rows[:, 1]]
    result = two_view(current, target, np.random.default_rng(seed), pipeline.verification)
    kept = result.inlier_mask
    return PairResult(
        distance_m=pair.distance_m,
        raw=len(rows),
        verified=result.inliers,
        status=result.status,
        confidence=result.confidence,
        disparity_rad=result.disparity_rad,
        yaw_error_rad=_error(result.yaw_rad, pair.yaw_rad),
        verified_errors_rad=_errors(pair, current[kept], target[kept], result),
        raw_errors_rad=_errors(pair, current, target, result),
    )


def _errors(
    pair: PosePair, current: np.ndarray, target: np.ndarray, result: TwoViewResult
) -> dict[str, float | None]:
    headings = {name: heading_estimate(name, current, target).heading_rad for name in METHODS[1:]}
    headings["epipolar"] = result.heading_rad if result.usable else None
    return {name: _error(heading, pair.heading_rad) for name, heading in headings.items()}


def _error(estimate_rad: float | None, true_rad: float) -> float | None:
    return (
        None
        if estimate_rad is None
        else abs(float(np.remainder(estimate_rad - true_rad + np.pi, 2 * np.pi) - np.pi))
    )
