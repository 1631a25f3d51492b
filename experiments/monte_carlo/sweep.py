"""Which priority function of methods 2 and 4: gains of exp, and others (THESIS Q1, row 101)."""

from dataclasses import dataclass

import numpy as np

from experiments.monte_carlo.scene import ScenePlan, lonlat_from
from services.planner.heading.methods import heading_estimate
from services.planner.heading.weights import WeightSettings
from shared.geometry.sphere import FloatArray, wrap_rad

WEIGHTED = ("2", "4", "5", "6")
FUNCTIONS: dict[str, WeightSettings] = {
    "one": WeightSettings(name="one"),
    "exp, 1 per radian": WeightSettings(unit="rad"),
    "exp, 3 per radian": WeightSettings(unit="rad", gain=3.0),
    "exp, 10 per radian": WeightSettings(unit="rad", gain=10.0),
    "exp, 30 per radian": WeightSettings(unit="rad", gain=30.0),
    "exp, 1 per degree": WeightSettings(),
    "exp, 2 per degree": WeightSettings(gain=2.0),
    "power 1": WeightSettings(name="power"),
    "power 2": WeightSettings(name="power", gain=2.0),
    "logistic, 1 per degree": WeightSettings(name="sigmoid"),
    "rank 2": WeightSettings(name="rank", gain=2.0),
    "rank 8": WeightSettings(name="rank", gain=8.0),
}


@dataclass(frozen=True)
class SweepPlan(ScenePlan):
    """All functions on the runs of one scene."""

    count: int = 60


def scene_sweep(plan: SweepPlan) -> FloatArray:
    """Mean absolute heading error (functions, weighted methods), degrees."""
    _, scene, choices = plan.draw(plan.count)
    current, target = lonlat_from(scene.current, scene.points), lonlat_from(scene.target, scene.points)
    errors = np.zeros((len(FUNCTIONS), len(WEIGHTED)))
    for chosen in choices:
        for row, weight in enumerate(FUNCTIONS.values()):
            for column, name in enumerate(WEIGHTED):
                heading = heading_estimate(name, current[chosen], target[chosen], weight).heading_rad
                wrong = np.pi / 2 if heading is None else abs(float(wrap_rad(heading - scene.heading_rad)))
                errors[row, column] += np.rad2deg(wrong) / plan.runs
    return errors
