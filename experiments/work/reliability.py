"""Whether confidence means what it says: answers by confidence, and the diagram of it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from experiments.work.page import SERIES
from services.launcher.terminal.output import rounded

RIGHT_DEG = 20.0
"""Off by less, a robot gets nearer and looks again."""

BINS = 10
"""Of confidence: the usual number for an expected calibration error (Guo et al. 2017)."""


def reliability(answers: Sequence[tuple[float, float]]) -> dict[str, Any]:
    """How often answers of a confidence are right, and the expected calibration error (ece).

    ece = sum over bins of n / N |share right - mean confidence|; None without an answer.

    Args:
        answers: confidence, 0 to 1, and by how much the heading is off, degrees.
    """
    confidence = np.array([one for one, _ in answers])
    right = np.array([off_deg < RIGHT_DEG for _, off_deg in answers], dtype=bool)
    number = np.minimum((confidence * BINS).astype(int), BINS - 1)
    bins, ece = [], 0.0
    for k in np.unique(number):
        inside = number == k
        mean, good = float(confidence[inside].mean()), float(right[inside].mean())
        ece += inside.mean() * abs(good - mean)
        bins.append({"confidence": rounded(mean), "right": rounded(good), "n": int(inside.sum())})
    return {"ece": rounded(ece) if bins else None, "bins": bins}


def draw_reliability(axes: Any, figures: Mapping[str, Any]) -> None:
    """Share of right answers against confidence; the area of a point grows with its answers."""
    bins = figures["bins"]
    axes.plot((0, 1), (0, 1), color="0.7", linewidth=1)
    most = max((one["n"] for one in bins), default=1)
    axes.scatter(
        [one["confidence"] for one in bins],
        [one["right"] for one in bins],
        s=[30 + 270 * one["n"] / most for one in bins],
        color=SERIES[0],
        alpha=0.7,
    )
    for one in bins:
        axes.annotate(str(one["n"]), (one["confidence"], one["right"]), fontsize=7, ha="center", va="center")
    axes.set(
        xlabel="confidence", ylabel=f"share within {RIGHT_DEG:g} deg", xlim=(-0.05, 1.05), ylim=(-0.05, 1.05)
    )
    axes.grid(alpha=0.3)
    ece = figures["ece"]
    axes.set_title(
        "reliability, numbers are answers" + (f"; error {ece:.2f}" if ece is not None else ""), fontsize=9
    )
