"""Absolute heading angle error (AHAE) of many runs in many scenes, equation (3.3) read as Q2 does."""

from dataclasses import dataclass

import numpy as np

from experiments.monte_carlo.scene import Placement, draw_scene, generator_of
from experiments.monte_carlo.votes import draw_choices, headings, vote_table
from services.planner.heading.weights import WeightSettings
from shared.geometry.sphere import FloatArray, wrap_rad

METHODS = ("1", "2", "3", "4", "5", "6")
COUNTS = (5, 8, 13, 21, 34, 60, 100, 150)
"""Matches per run. The thesis names 13, 34, 60 and 150; the rest of its series is unstated (Q27)."""


DEFAULT_WEIGHT = WeightSettings()


@dataclass(frozen=True)
class AhaePlan:
    """Size of a study: the thesis's is 100 scenes of 2000 runs (3.2.1)."""

    placement: Placement
    scene: int
    seed: int
    runs: int = 2000
    counts: tuple[int, ...] = COUNTS
    weight: WeightSettings = DEFAULT_WEIGHT


def scene_errors(plan: AhaePlan) -> FloatArray:
    """Mean and standard deviation over the runs of one scene, (2, methods, counts), degrees."""
    rng = generator_of(plan.placement, plan.scene, plan.seed)
    scene = draw_scene(plan.placement, rng)
    chosen = draw_choices(plan.runs, max(plan.counts), len(scene.points), rng)
    found = headings(vote_table(scene, plan.weight), chosen, plan.counts)
    errors = np.rad2deg(np.abs(wrap_rad(found - scene.heading_rad)))
    return np.stack([errors.mean(axis=-1), errors.std(axis=-1)])
