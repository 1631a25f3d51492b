"""Distance covered percent error (DCPE) of paths that follow a heading method, equation (3.6).

A point without dynamics steps along the estimated heading; its keypoints stay the same and are seen anew from
every place (thesis 3.2.2).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import torch
from torch import Tensor

from experiments.monte_carlo.ahae import DEG, METHODS, parts
from experiments.monte_carlo.batched import batch_headings
from experiments.monte_carlo.scene import MonteCarloScene, ScenePlan
from shared.geometry.sphere import FloatArray

STEP_M = 0.2
"""Speed times time step; also how near counts as reached. The thesis states neither (Q27)."""
Steer = Callable[[Tensor, Tensor], Tensor]
"""Headings (B,) from what is seen here and at the target, (B, N, 2) longitude, latitude."""


@dataclass(frozen=True)
class DcpePlan(ScenePlan):
    """Paths of one scene and one number of matches."""

    count: int = 34
    gain_per_rad: float = DEG
    device: str = "cpu"


def scene_paths(plan: DcpePlan) -> FloatArray:
    """DCPE of all runs with each method, (methods, runs), percent, at most 100."""
    _, scene, chosen = plan.draw(plan.count)
    steers = [partial(batch_headings, method, gain_per_rad=plan.gain_per_rad) for method in METHODS]
    found = [
        [follow(scene, scene.points[chosen[part]], steer, plan.device) for steer in steers]
        for part in parts(plan.runs, plan.count, plan.device)
    ]
    return np.concatenate([np.stack(each) for each in found], axis=1)


def follow(scene: MonteCarloScene, matches: FloatArray, steer: Steer, device: str = "cpu") -> FloatArray:
    """DCPE (runs,) of the paths that one way of steering makes; 100 where it took twice the straight way."""
    points = torch.as_tensor(matches, dtype=torch.float64, device=device)
    goal = torch.as_tensor(scene.target, dtype=torch.float64, device=device)
    target = lonlat_of(goal.expand(len(points), 2), points)
    place = torch.as_tensor(scene.current, dtype=torch.float64, device=device).repeat(len(points), 1)
    covered = torch.full((len(points),), 2.0 * scene.distance_m, dtype=torch.float64, device=device)
    going = torch.arange(len(points), device=device)
    travelled = 0.0
    while travelled < 2.0 * scene.distance_m and len(going):
        left = torch.linalg.vector_norm(goal - place, dim=1)
        arrived = left <= STEP_M
        covered[going[arrived]] = (travelled + left[arrived]).clamp_max(2.0 * scene.distance_m)
        going, place, points, target = (x[~arrived] for x in (going, place, points, target))
        if len(going) == 0:
            break
        heading = steer(lonlat_of(place, points), target)
        place = place + STEP_M * torch.stack([torch.cos(heading), torch.sin(heading)], 1)
        travelled += STEP_M
    return np.asarray(100.0 * (covered.cpu().numpy() / scene.distance_m - 1.0))


def lonlat_of(places: Tensor, points: Tensor) -> Tensor:
    """Longitude and latitude (B, N, 2) of points (B, N, 3) from places (B, 2)."""
    offset = points[..., :2] - places[:, None]
    latitude = torch.atan2(points[..., 2], torch.linalg.vector_norm(offset, dim=-1))
    return torch.stack([torch.atan2(offset[..., 1], offset[..., 0]), latitude], -1)
