"""Statistics over pose pairs: errors by method, and matches, disparity and error by distance. Pure."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from experiments.rendered.headings import METHODS, PairResult
from experiments.work.reliability import reliability
from services.launcher.terminal.output import rounded

BINS_M = (0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 12.0)
"""Of what is drawn indoors (0.3 to 3 m) and outdoors (0.5 to 12 m), finer where more changes."""


def method_table(results: Sequence[PairResult], raw: bool = False) -> dict[str, dict[str, float]]:
    """Median, mean and 90th percentile of each method's heading error over the pairs it answered, degrees."""
    return {
        name: _statistics([(r.raw_errors_rad if raw else r.verified_errors_rad)[name] for r in results])
        for name in METHODS
    }


def distance_table(results: Sequence[PairResult]) -> list[dict[str, float | str]]:
    """One row per bin of distance; the last bin includes its end."""
    rows: list[dict[str, float | str]] = []
    for low, high in pairwise(BINS_M):
        inside = [r for r in results if low <= r.distance_m < high or r.distance_m == high == BINS_M[-1]]
        if inside:
            rows.append({"distance_m": f"{low:g}-{high:g}", **_row(inside)})
    return rows


def confidence_table(results: Sequence[PairResult]) -> dict[str, Any]:
    """How often bearings of the two-view method are right, by their confidence."""
    errors = [(r.confidence, r.verified_errors_rad["epipolar"]) for r in results]
    return reliability([(confidence, math.degrees(e)) for confidence, e in errors if e is not None])


def status_counts(results: Iterable[PairResult]) -> dict[str, int]:
    """How often two-view geometry gave which answer."""
    return dict(Counter(result.status for result in results))


def _row(inside: Sequence[PairResult]) -> dict[str, float]:
    verified = [r.verified for r in inside]
    disparities = np.rad2deg([r.disparity_rad for r in inside if r.disparity_rad is not None])
    error = _statistics([r.verified_errors_rad["epipolar"] for r in inside])
    return {
        "pairs": len(inside),
        "raw": rounded(np.median([r.raw for r in inside]), 1),
        "verified": rounded(np.median(verified), 1),
        "verified_p10": rounded(np.percentile(verified, 10), 1),
        "verified_p90": rounded(np.percentile(verified, 90), 1),
        "disparity_deg": rounded(np.median(disparities), 2) if len(disparities) else 0.0,
        "answered": error["answered"],
        "error_median_deg": error["median_deg"],
        "error_mean_deg": error["mean_deg"],
        "error_p99_deg": error["p99_deg"],
    }


def _statistics(errors_rad: Sequence[float | None]) -> dict[str, float]:
    degrees = np.rad2deg([error for error in errors_rad if error is not None])
    if not len(degrees):
        return {"median_deg": -1.0, "mean_deg": -1.0, "p90_deg": -1.0, "p99_deg": -1.0, "answered": 0}
    return {
        "median_deg": rounded(np.median(degrees), 3),
        "mean_deg": rounded(np.mean(degrees), 3),
        "p90_deg": rounded(np.percentile(degrees, 90), 3),
        "p99_deg": rounded(np.percentile(degrees, 99), 3),
        "answered": len(degrees),
    }
