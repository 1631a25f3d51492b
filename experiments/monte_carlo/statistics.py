"""Figures per scene, and their means and deviations over the scenes (thesis figures 3.16 to 3.66)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from experiments.monte_carlo.ahae import METHODS
from shared.geometry.sphere import FloatArray


@dataclass(frozen=True, eq=False)
class Statistics:
    """Figures of one placement.

    Attributes:
        counts: matches per run.
        means: (scenes, methods, counts) mean over a scene's runs.
        stds: (scenes, methods, counts) standard deviation over a scene's runs.
    """

    counts: tuple[int, ...]
    means: FloatArray
    stds: FloatArray

    def mean_of_means(self, counts: Sequence[int] | None = None) -> dict[str, float]:
        """By method, averaged over the counts (all where none are named)."""
        return self._by_method(self.means.mean(axis=0), counts)

    def std_of_means(self, counts: Sequence[int] | None = None) -> dict[str, float]:
        """How much the scenes' means differ."""
        return self._by_method(self.means.std(axis=0), counts)

    def mean_of_stds(self, counts: Sequence[int] | None = None) -> dict[str, float]:
        """How much the runs of a scene differ."""
        return self._by_method(self.stds.mean(axis=0), counts)

    def std_of_stds(self, counts: Sequence[int] | None = None) -> dict[str, float]:
        """How much the scenes differ in that."""
        return self._by_method(self.stds.std(axis=0), counts)

    def mean_outside_box(self, method: str) -> tuple[int, ...]:
        """Counts at which the mean of the scenes' means lies above their upper quartile."""
        means = self.means[:, METHODS.index(method)]
        above = means.mean(axis=0) > np.quantile(means, 0.75, axis=0)
        return tuple(n for n, outside in zip(self.counts, above, strict=True) if outside)

    def rows(self, placement: str, unit: str) -> list[dict[str, object]]:
        """One JSON object per method and count."""
        mean, std = self.means.mean(axis=0), self.stds.mean(axis=0)
        return [
            {
                "method": method,
                "placement": placement,
                "keypoints": count,
                f"mean_{unit}": round(float(mean[i, k]), 3),
                f"std_{unit}": round(float(std[i, k]), 3),
            }
            for i, method in enumerate(METHODS)
            for k, count in enumerate(self.counts)
        ]

    def _by_method(self, table: FloatArray, counts: Sequence[int] | None) -> dict[str, float]:
        chosen = [self.counts.index(n) for n in (self.counts if counts is None else counts)]
        return {method: float(table[row, chosen].mean()) for row, method in enumerate(METHODS)}
