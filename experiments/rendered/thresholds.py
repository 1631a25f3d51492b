"""From measured pairs to thresholds of similarity. Pure.

The thesis found 80 and 110 of 150 for its own pipeline by trial. Here the same questions are asked of
measured pairs: below which S can a bearing not be trusted, and how similar are frames as far apart as
nodes should be?
"""

import math
from collections.abc import Sequence

import numpy as np

from experiments.rendered.headings import PairResult
from services.launcher.client.environments import Spans
from services.launcher.terminal.output import rounded

WRONG_RAD = math.radians(20.0)
"""As far as the bearing of an edge may be off (services/launcher/evaluation/map_quality.py)."""

SAFETY = 1.333
"""The thesis's safety factor of the map thresholds over those of driving (section 6.1: 60 becomes 80)."""

MIN_VIA = 15
"""Just below the least that any profile of services/planner/profiles.py was measured to need (16)."""


def propose(results: Sequence[PairResult], spans: Spans) -> dict[str, float]:
    """Thresholds for `services.planner.profiles`, in verified matches.

    Returns:
        s_via_min: no bearing of a pair with more was wrong by 20 degrees, at least MIN_VIA.
        s_edge_min: the same times the thesis's safety factor.
        s_node_max: median between frames as far apart as nodes should be.
        s_via_max: median between frames nearer than a reached via point.
        disparity_rad_per_m: median of disparity over distance where nodes should be.

    Raises:
        ValueError: no pair at those distances; measure more.
    """
    wrong = [r.verified for r in results if _wrong(r)]
    s_via_min = max(MIN_VIA, max(wrong, default=0))
    return {
        "s_via_min": s_via_min,
        "s_edge_min": math.ceil(SAFETY * s_via_min),
        "s_node_max": _median(results, *spans.node_m),
        "s_via_max": _median(results, 0.0, spans.near_m),
        "disparity_rad_per_m": _disparity_rad_per_m(results, *spans.node_m),
    }


def _wrong(result: PairResult) -> bool:
    error_rad = result.verified_errors_rad["epipolar"]
    return error_rad is not None and error_rad > WRONG_RAD


def _median(results: Sequence[PairResult], low_m: float, high_m: float) -> int:
    inside = [r.verified for r in results if low_m <= r.distance_m < high_m]
    if not inside:
        raise ValueError(f"no pair between {low_m} and {high_m} m: measure more pairs (--pairs)")
    return round(float(np.median(inside)))


def _disparity_rad_per_m(results: Sequence[PairResult], low_m: float, high_m: float) -> float:
    ratios = [
        r.disparity_rad / r.distance_m
        for r in results
        if low_m <= r.distance_m < high_m and r.disparity_rad is not None
    ]
    return rounded(np.median(ratios)) if ratios else 0.0
