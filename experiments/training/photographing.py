"""Pairs of panoramas of one world with all that is known of them; loads SAPIEN where pictures are taken."""

from dataclasses import dataclass

import numpy as np

from experiments.rendered.pairs import PosePair, draw_pair
from experiments.training.sights import CameraPose, Sight
from shared.messages.simulation import Pose
from simulator.cache_folder import user_cache_dir
from simulator.disturbances.levels import Disturbances
from simulator.settings import CameraSettings, SimulationSettings
from simulator.world.freespace import FreeSpace
from simulator.world.world_file import WorldFile

TRIES = 4
"""Distances that are tried where a world has no room for the first; chosen."""


@dataclass(frozen=True)
class Conditions:
    """What one end of all pairs of a shard has in common.

    Attributes:
        height_m: of the camera.
        illumination: time of day, 0 (noon) to 1 (lamps only).
        furniture: share of movable furniture that stands elsewhere or is gone.
        seed: draws which.
    """

    height_m: float = 0.8
    illumination: float = 0.0
    furniture: float = 0.0
    seed: int = 0


class Photographer:
    """Takes pictures of a world under some conditions, with ranges."""

    def __init__(self, world: WorldFile, conditions: Conditions, width_px: int) -> None:
        """Build the scene: seconds, and longer where its light is not in the cache."""
        from simulator.simulation import Simulation

        levels = Disturbances(illumination=conditions.illumination, furniture=conditions.furniture)
        camera = CameraSettings(width_px=width_px, height_m=conditions.height_m)
        settings = SimulationSettings(camera=camera, cache_dir=user_cache_dir(), disturbances=levels)
        self._simulation = Simulation(world, settings, conditions.seed)
        self._height_m = conditions.height_m

    def sight(self, pose: Pose, tilt: tuple[float, float] = (0.0, 0.0)) -> Sight:
        """What is seen from there."""
        picture, ranges = self._simulation.measured_at(pose.x_m, pose.y_m, pose.yaw_rad, tilt)
        at = CameraPose(pose.x_m, pose.y_m, pose.yaw_rad, self._height_m, tilt)
        return Sight(picture, ranges, at)


def draw_apart(space: FreeSpace, rng: np.random.Generator, apart_m: tuple[float, float]) -> PosePair | None:
    """Two poses that see each other, their distance even in `apart_m`; None where there is no room."""
    for _ in range(TRIES):
        try:
            return draw_pair(space, rng, float(rng.uniform(*apart_m)))
        except ValueError:
            continue
    return None


def draw_tilt(rng: np.random.Generator, sigma_rad: float) -> tuple[float, float]:
    """Pitch and roll of one picture."""
    pitch, roll = (float(angle) for angle in rng.normal(0.0, sigma_rad, 2)) if sigma_rad else (0.0, 0.0)
    return pitch, roll
