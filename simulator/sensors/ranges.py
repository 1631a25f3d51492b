"""Twelve sonar-like distance sensors. Pure: fans of rays against the outlines of all the robot could hit."""

import numpy as np
import numpy.typing as npt

from simulator.settings import RangeSettings
from simulator.world.footprints import Footprints, cast_rays

FloatArray = npt.NDArray[np.float64]


def sensor_angles_rad(settings: RangeSettings) -> FloatArray:
    """Axes of the sensors in the robot frame, counter-clockwise from straight ahead; (count,) radians."""
    return np.arange(settings.count, dtype=np.float64) * (2.0 * np.pi / settings.count)


def measure(
    x_m: float,
    y_m: float,
    yaw_rad: float,
    shapes: Footprints,
    settings: RangeSettings,
    rng: np.random.Generator,
) -> FloatArray:
    """Distances of all sensors at a robot pose.

    Each sensor reports the nearest outline inside its beam, measured horizontally from the robot's centre,
    plus Gaussian noise, clipped to 0..max_m. Nothing within range reads max_m exactly.

    Args:
        x_m: robot position.
        y_m: robot position.
        yaw_rad: robot heading.
        shapes: outlines of solids in the robot's band of heights, without the robot itself.
        settings: number, beam, range and noise.
        rng: source of the noise.

    Returns:
        (count,) metres.
    """
    fan = np.linspace(-settings.beam_rad / 2, settings.beam_rad / 2, settings.rays)
    angles = yaw_rad + sensor_angles_rad(settings)[:, None] + fan[None, :]
    hits = cast_rays(np.array([x_m, y_m]), angles.ravel(), shapes, settings.max_m).reshape(angles.shape)
    nearest = hits.min(axis=1)
    noise = rng.normal(0.0, settings.noise_m, settings.count)
    seen = nearest < settings.max_m
    return np.where(seen, np.clip(nearest + noise, 0.0, settings.max_m), settings.max_m)
