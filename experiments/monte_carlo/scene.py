"""Random scenes: keypoints, a current and a target place (thesis 3.2.1, figure 3.13).

World frame: x east, y north, metres; both cameras look east, since no method depends on yaw. Heights are
relative to the camera.
"""

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from shared.geometry.sphere import FloatArray

IndexArray = npt.NDArray[np.intp]
Placement = Literal["centre", "north", "north_east"]
PLACEMENTS: tuple[Placement, ...] = get_args(Placement)

KEYPOINTS, SIDE_M, HEIGHT_M = 1000, 20.0, 2.0
"""Keypoints, side of the square, and how far off the camera's height they lie: the thesis is silent (Q27)."""

NEAREST_M = 1.0
"""The current place is at least this far from the target: nearer, no direction is worth asking for."""

TARGETS: dict[Placement, tuple[float, float]] = {
    "centre": (0.0, 0.0),
    "north": (0.0, SIDE_M / 2),
    "north_east": (SIDE_M / 2, SIDE_M / 2),
}
"""At the north edge all keypoints lie in [-180, 0] degrees and all headings in [0, 180] (3.2.1.2); in the
corner in [-180, -90] and [0, 90] (3.2.1.3)."""


@dataclass(frozen=True, eq=False)
class MonteCarloScene:
    """One scene.

    Attributes:
        points: (K, 3) keypoints, metres.
        current: (2,) where the robot is.
        target: (2,) where it should go.
    """

    points: FloatArray
    current: FloatArray
    target: FloatArray

    @property
    def heading_rad(self) -> float:
        """True heading from the current to the target place."""
        east, north = self.target - self.current
        return math.atan2(north, east)

    @property
    def distance_m(self) -> float:
        """Length of the straight way, d_m of equation (3.6)."""
        return float(np.hypot(*(self.target - self.current)))


@dataclass(frozen=True)
class ScenePlan:
    """Runs in one scene; its draws are the same whoever works it out."""

    placement: Placement
    scene: int
    seed: int
    runs: int

    def draw(self, count: int) -> tuple[np.random.Generator, MonteCarloScene, IndexArray]:
        """The scene and the `count` matches of each run, (runs, count) indices of its points."""
        rng = np.random.default_rng([self.seed, self.scene, len(self.placement)])
        scene = draw_scene(self.placement, rng)
        return rng, scene, draw_choices(self.runs, count, len(scene.points), rng)


def draw_scene(placement: Placement, rng: np.random.Generator, keypoints: int = KEYPOINTS) -> MonteCarloScene:
    """Uniform keypoints and a uniform current place; the target where the placement says."""
    half = SIDE_M / 2
    low, high = np.array([-half, -half, -HEIGHT_M]), np.array([half, half, HEIGHT_M])
    points = rng.uniform(low, high, (keypoints, 3))
    target = np.array(TARGETS[placement])
    current = rng.uniform(-half, half, 2)
    while np.hypot(*(current - target)) < NEAREST_M:
        current = rng.uniform(-half, half, 2)
    return MonteCarloScene(points, current, target)


def draw_choices(runs: int, most: int, of: int, rng: np.random.Generator) -> IndexArray:
    """(runs, most) keypoints per run, in random order, none twice."""
    return np.argsort(rng.random((runs, of)), axis=1)[:, :most]


def lonlat_from(place: FloatArray, points: FloatArray) -> FloatArray:
    """Longitude and latitude (K, 2), radians, of points (K, 3) seen from a place (2,)."""
    east, north = (points[:, :2] - place).T
    return np.stack([np.arctan2(north, east), np.arctan2(points[:, 2], np.hypot(east, north))], axis=1)
