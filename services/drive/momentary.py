"""The thesis's obstacle avoidance, section 4.3: away from what is near, without memory."""

import math

import numpy as np

from services.drive.steering import Steering


def obstacle_heading(
    angles_rad: tuple[float, ...], distances_m: tuple[float, ...], range_m: float
) -> float | None:
    """Direction of the obstacles nearer than `range_m`: sum of their unit vectors; None if none."""
    near = [angle for angle, distance in zip(angles_rad, distances_m, strict=True) if distance < range_m]
    if not near:
        return None
    return math.atan2(sum(map(math.sin, near)), sum(map(math.cos, near)))


def steer_away(heading_rad: float, obstacle_rad: float | None, rng: np.random.Generator) -> Steering:
    """Blend w1 (away from the obstacle) with 1 - w1 (the estimate), w1 uniform in (0.5, 1.0), figure 4.9."""
    if obstacle_rad is None:
        return Steering(heading_rad, False, "free")
    weight = float(rng.uniform(0.5, 1.0))
    x = (1.0 - weight) * math.cos(heading_rad) - weight * math.cos(obstacle_rad)
    y = (1.0 - weight) * math.sin(heading_rad) - weight * math.sin(obstacle_rad)
    return Steering(math.atan2(y, x), True, f"away from obstacle at {math.degrees(obstacle_rad):.0f} deg")
