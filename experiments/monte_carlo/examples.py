"""Single scenes that show why a method fails (thesis figures 3.14, 3.15, 3.50, 3.67 and 3.68)."""

from dataclasses import dataclass
from functools import partial

import numpy as np
import torch

from experiments.monte_carlo.batched import batch_headings
from experiments.monte_carlo.scene import MonteCarloScene, Placement, draw_scene, lonlat_from
from experiments.monte_carlo.tracking import DEG, STEP_M, follow, lonlat_of
from experiments.monte_carlo.votes import IndexArray, draw_choices
from services.planner.heading.votes import latitude_votes, pair_votes
from shared.geometry.sphere import FloatArray, wrap_rad

COUNT = 34


@dataclass(frozen=True, eq=False)
class PairCloud:
    """All pairs of one run: growth of the longitude difference, and how far the bisector points astray."""

    growth_deg: FloatArray
    error_deg: FloatArray


def pair_cloud(placement: Placement, seed: int, count: int = 150) -> PairCloud:
    """The relation of figure 3.14: the more a pair spreads, the truer its bisector."""
    scene, chosen = _scene_and_choice(placement, seed, count)
    votes = pair_votes(*_seen(scene, chosen))
    angle = np.arctan2(votes.directions[:, 1], votes.directions[:, 0])
    error = np.rad2deg(np.abs(wrap_rad(angle - scene.heading_rad)))
    return PairCloud(np.rad2deg(votes.growth_rad), error)


@dataclass(frozen=True, eq=False)
class LatitudeCase:
    """Figure 3.15: matches whose latitude shrinks though the way leads past them.

    Attributes:
        scene: keypoints and places.
        chosen: the matches of the run.
        astray: which of them vote more than a right angle away from the true heading.
    """

    scene: MonteCarloScene
    chosen: IndexArray
    astray: np.ndarray


def latitude_case(placement: Placement, seed: int, count: int = 150) -> LatitudeCase:
    """A run and its misleading latitude votes."""
    scene, chosen = _scene_and_choice(placement, seed, count)
    votes = latitude_votes(*_seen(scene, chosen))
    angle = np.arctan2(votes.directions[:, 1], votes.directions[:, 0])
    return LatitudeCase(scene, chosen, np.abs(wrap_rad(angle - scene.heading_rad)) > np.pi / 2)


@dataclass(frozen=True, eq=False)
class FailedPath:
    """A path that never arrived.

    Attributes:
        scene: keypoints and places.
        chosen: the matches of the run.
        path: (T, 2) places, metres.
        heading_rad: (T - 1,) heading of each step.
    """

    scene: MonteCarloScene
    chosen: IndexArray
    path: FloatArray
    heading_rad: FloatArray


def failed_path(method: str, placement: Placement, seed: int, tries: int = 200) -> FailedPath | None:
    """The first run whose path took twice the straight way; None where none of the tries did."""
    for number in range(tries):
        scene, chosen = _scene_and_choice(placement, seed + number, COUNT)
        steer = partial(batch_headings, method, gain_per_rad=DEG)
        if scene.distance_m > 4.0 and follow(scene, chosen[None], steer)[0] >= 100.0:
            return _traced(scene, chosen, method)
    return None


def _traced(scene: MonteCarloScene, chosen: IndexArray, method: str) -> FailedPath:
    points = torch.as_tensor(scene.points[chosen])[None]
    target = lonlat_of(torch.as_tensor(scene.target)[None], points)
    path, headings = [scene.current], []
    for _ in range(int(2.0 * scene.distance_m / STEP_M)):
        seen = lonlat_of(torch.as_tensor(path[-1])[None], points)
        heading = float(batch_headings(method, seen, target, DEG))
        headings.append(heading)
        path.append(path[-1] + STEP_M * np.array([np.cos(heading), np.sin(heading)]))
    return FailedPath(scene, chosen, np.array(path), np.array(headings))


def _scene_and_choice(placement: Placement, seed: int, count: int) -> tuple[MonteCarloScene, IndexArray]:
    rng = np.random.default_rng(seed)
    scene = draw_scene(placement, rng)
    return scene, draw_choices(1, count, len(scene.points), rng)[0]


def _seen(scene: MonteCarloScene, chosen: IndexArray) -> tuple[FloatArray, FloatArray]:
    points = scene.points[chosen]
    return lonlat_from(scene.current, points), lonlat_from(scene.target, points)
