"""A room of which every range is known: an empty box round the origin."""

import numpy as np

from experiments.training.sights import CameraPose, Sight
from simulator.sensors.panorama import directions

HALF_M, WIDTH = np.array([4.0, 3.0, 2.0]), 512


def in_a_box(pose: CameraPose, hidden: bool = False) -> Sight:
    """What a camera sees in the box; if hidden, something stands before everything."""
    rays = directions(WIDTH) @ pose.rotation.T
    with np.errstate(divide="ignore"):
        ways = (np.where(rays > 0, HALF_M, -HALF_M) - pose.position_m) / rays
    ranges = np.nanmin(np.where(ways > 0, ways, np.inf), axis=-1)
    return Sight(np.zeros((WIDTH // 2, WIDTH, 3), np.uint8), 0.3 * ranges if hidden else ranges, pose)
