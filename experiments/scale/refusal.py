"""When a picture is "not in this map": from how many verified matches on an answer is believed. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from services.launcher.terminal.output import rounded


@dataclass(frozen=True)
class Refusal:
    """Errors of one threshold of S.

    Attributes:
        threshold: fewer verified matches mean "not in this map".
        false_accept: share of foreign pictures that were taken for a node.
        false_reject: share of pictures of the map that were refused.
    """

    threshold: int
    false_accept: float
    false_reject: float


def refusal_curve(own: Sequence[int], foreign: Sequence[int]) -> list[Refusal]:
    """Both errors for each threshold from 0 up to the largest S that occurs."""
    own_s, foreign_s = np.array(own), np.array(foreign)
    return [
        Refusal(t, rounded((foreign_s >= t).mean()), rounded((own_s < t).mean()))
        for t in range(int(max(own_s.max(), foreign_s.max())) + 2)
    ]


def calibrated(curve: Sequence[Refusal]) -> Refusal:
    """The threshold with the fewest errors of both kinds; in the middle of those that are equally good."""
    least = min(each.false_accept + each.false_reject for each in curve)
    best = [each for each in curve if each.false_accept + each.false_reject == least]
    return best[len(best) // 2]
