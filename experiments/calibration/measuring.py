"""What a pipeline makes of two pictures whose bearing is known. Pure."""

import math

from experiments.calibration.thresholds import Pair
from experiments.rendered.headings import PairResult
from services.features.matching.verification import Candidate, verify
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.planner.mapping.edges import CONFIDENCE_MIN
from services.planner.profiles import Profile
from shared.messages.matching import NodeMatch


def measured(
    here: FeatureSet,
    there: FeatureSet,
    bearing_rad: float,
    distance_m: float | None,
    pipeline: Pipeline,
    seed: int,
) -> Pair:
    """One pair.

    Args:
        here: the frame.
        there: the other picture.
        bearing_rad: of the other's place in the frame.
        distance_m: between the two; None where nobody knows.
        pipeline: matches and verifies.
        seed: of the draws.
    """
    match = matched(here, there, pipeline, seed)
    answered = match.status == "ok" and match.heading_rad is not None and match.confidence >= CONFIDENCE_MIN
    error_rad = None
    if answered and match.heading_rad is not None:
        error_rad = abs(math.remainder(match.heading_rad - bearing_rad, math.tau))
    return Pair(match.inliers, error_rad, distance_m)


def matched(here: FeatureSet, there: FeatureSet, pipeline: Pipeline, seed: int) -> NodeMatch:
    """The frame against the other picture, with all matches."""
    (pairs,) = pipeline.matcher.match(here, [there])
    return verify(here, Candidate(0, there), pairs, seed, pipeline.verification, True)


def of_rendering(result: PairResult, rules: Profile) -> Pair:
    """A rendered pair that was measured for all heading methods; S as the rules count it."""
    similarity = result.verified if rules.sensing.similarity == "verified" else result.raw
    answered = result.confidence >= CONFIDENCE_MIN
    error_rad = result.verified_errors_rad["epipolar"] if answered else None
    return Pair(similarity, error_rad, result.distance_m, result.is_free)
