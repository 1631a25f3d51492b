"""All heading methods with bearing noise and wrong matches, which the thesis left out."""

from dataclasses import dataclass

import numpy as np
import torch

from experiments.monte_carlo.scene import MonteCarloScene, ScenePlan, lonlat_from
from experiments.monte_carlo.tracking import follow
from services.planner.heading.methods import heading_estimate
from shared.geometry.sphere import FloatArray, wrap_rad
from shared.geometry.two_view import two_view
from shared.geometry.two_view_types import TwoViewSettings

ALL_METHODS = ("1", "2", "3", "4", "5", "6", "epipolar")
NO_ANSWER_DEG = 90.0
"""Error of a method that gives no heading: what a blind guess makes on average."""


@dataclass(frozen=True)
class NoisePlan(ScenePlan):
    """Runs in one scene under one condition.

    Attributes:
        noise_deg: standard deviation of each longitude and latitude, both frames.
        outliers: share of the matches whose target bearing belongs to another keypoint.
    """

    count: int = 60
    noise_deg: float = 0.5
    outliers: float = 0.2

    @property
    def two_view(self) -> TwoViewSettings:
        """Limits for this noise: an inlier lies within three deviations; these scenes are flat."""
        threshold_deg = max(0.7, 3.0 * self.noise_deg)
        return TwoViewSettings(threshold_rad=float(np.deg2rad(threshold_deg)), tilting=False)


def noisy_errors(plan: NoisePlan) -> FloatArray:
    """Absolute heading errors (methods, runs), degrees."""
    rng, scene, chosen = plan.draw(plan.count)
    errors = np.empty((len(ALL_METHODS), plan.runs))
    for run, indices in enumerate(chosen):
        current = disturbed(lonlat_from(scene.current, scene.points[indices]), plan, rng)
        target = disturbed(lonlat_from(scene.target, scene.points[indices]), plan, rng)
        target = with_outliers(target, plan, rng)
        geometry = two_view(current, target, rng, plan.two_view)
        for row, name in enumerate(ALL_METHODS):
            two_view_rad = geometry.heading_rad if geometry.usable else None
            by_votes = name != "epipolar"
            heading = heading_estimate(name, current, target).heading_rad if by_votes else two_view_rad
            error = None if heading is None else abs(float(wrap_rad(heading - scene.heading_rad)))
            errors[row, run] = NO_ANSWER_DEG if error is None else np.rad2deg(error)
    return errors


def epipolar_paths(plan: NoisePlan) -> FloatArray:
    """DCPE (runs,) of paths that follow the epipolar direction, percent; see tracking.scene_paths.

    A step without an answer keeps the heading of the step before.
    """
    rng, scene, chosen = plan.draw(plan.count)
    return np.concatenate([_path(scene, scene.points[row], plan, rng) for row in chosen])


def _path(
    scene: MonteCarloScene, matches: FloatArray, plan: NoisePlan, rng: np.random.Generator
) -> FloatArray:
    target = with_outliers(disturbed(lonlat_from(scene.target, matches), plan, rng), plan, rng)
    last = [0.0]

    def steer(current: torch.Tensor, _target: torch.Tensor) -> torch.Tensor:
        result = two_view(disturbed(current[0].numpy(), plan, rng), target, rng, plan.two_view)
        if result.usable and result.heading_rad is not None:
            last[0] = result.heading_rad
        return torch.tensor(last, dtype=torch.float64)

    return follow(scene, matches[None], steer)


def disturbed(lonlat: FloatArray, plan: NoisePlan, rng: np.random.Generator) -> FloatArray:
    """Bearings with normal noise."""
    return lonlat + rng.normal(0.0, np.deg2rad(plan.noise_deg), lonlat.shape)


def with_outliers(target: FloatArray, plan: NoisePlan, rng: np.random.Generator) -> FloatArray:
    """Target bearings of which a share is replaced by those of other keypoints, in a circle."""
    wrong = rng.permutation(len(target))[: round(plan.outliers * len(target))]
    mixed = target.copy()
    mixed[wrong] = target[np.roll(wrong, 1)]
    return mixed
