"""Absolute heading angle error (AHAE) of many runs in many scenes, equation (3.3) read as Q2 does.

And the statistics over scenes that AHAE and DCPE share (thesis figures 3.16 to 3.66).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch

from experiments.monte_carlo.batched import all_headings
from experiments.monte_carlo.scene import ScenePlan, lonlat_from
from shared.geometry.sphere import FloatArray, wrap_rad

METHODS = ("1", "2", "3", "4", "5", "6")
COUNTS = (5, 8, 13, 21, 34, 60, 100, 150)
"""Matches per run. The thesis names 13, 34, 60 and 150; the rest of its series is unstated (Q27)."""

MOST_PAIRS = {"cpu": 100_000, "cuda": 50_000_000}
"""Pairs of matches worked on at once: what fits the cache of a core, or keeps a GPU busy."""

DEG = 180.0 / np.pi
"""Gain of exp when its argument is in degrees, per radian."""


@dataclass(frozen=True)
class AhaePlan(ScenePlan):
    """Size of a study: the thesis's is 100 scenes of 2000 runs (3.2.1)."""

    counts: tuple[int, ...] = COUNTS
    gain_per_rad: float = DEG


def scene_errors(plan: AhaePlan) -> FloatArray:
    """Mean and standard deviation over the runs of one scene, (2, methods, counts), degrees.

    The first n matches of a run are its run with n matches: this makes the counts comparable.
    """
    _, scene, chosen = plan.draw(max(plan.counts))
    seen = [torch.as_tensor(lonlat_from(spot, scene.points)) for spot in (scene.current, scene.target)]
    errors = np.empty((len(METHODS), len(plan.counts), plan.runs))
    for column, count in enumerate(plan.counts):
        for part in parts(plan.runs, count, "cpu"):
            current, target = (lonlat[torch.as_tensor(chosen[part, :count])] for lonlat in seen)
            found = all_headings(current, target, plan.gain_per_rad).numpy()
            errors[:, column, part] = np.rad2deg(np.abs(wrap_rad(found - scene.heading_rad)))
    return np.stack([errors.mean(axis=-1), errors.std(axis=-1)])


def parts(runs: int, count: int, device: str) -> list[slice]:
    """Runs of `count` matches in parts that are worked on at once."""
    size = max(1, MOST_PAIRS[device] // count**2)
    return [slice(start, start + size) for start in range(0, runs, size)]


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
