"""Recall, precision and the area under their curve, as section 3.1 of the thesis defines them."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import FloatArray

THRESHOLDS = 25  # unstated in the thesis (Q27)


@dataclass(frozen=True, eq=False)
class Curve:
    """One precision-recall curve, recall ascending."""

    recall: FloatArray
    precision: FloatArray

    @property
    def area(self) -> float:
        """Area under the curve as steps: each recall is reached at its own precision (figure 3.11)."""
        return float(np.sum(np.diff(self.recall, prepend=0.0) * self.precision))


def curve_of(
    distance: FloatArray, correct: npt.NDArray[np.bool_], correspondences: int, thresholds: int = THRESHOLDS
) -> Curve:
    """Curve of matches accepted below rising thresholds, equations (3.1) and (3.2).

    Args:
        distance: (M,) of every match, smaller is better.
        correct: (M,) whether it is right.
        correspondences: keypoints that could have been matched; the smaller count of both pictures (Q26).
        thresholds: how many, spread evenly over the matches.
    """
    if len(distance) == 0 or correspondences == 0:
        return Curve(np.zeros(1), np.zeros(1))
    levels = np.quantile(distance, np.linspace(0.0, 1.0, thresholds + 1)[1:])
    accepted = distance[None, :] <= levels[:, None]
    right = (accepted & correct).sum(axis=1)
    recall, precision = right / correspondences, right / np.maximum(accepted.sum(axis=1), 1)
    order = np.lexsort((-precision, recall))  # of equal recalls the best counts
    return Curve(recall[order], precision[order])
