"""Motion blur: the mean of pictures at poses through which the camera went during the exposure. Pure."""

import numpy as np

from simulator.scene.parts import Pose2
from simulator.sensors.panorama import Image

EXPOSURE_S = 0.2  # at level 1; chosen: 8 cm of way at 0.4 m/s
PICTURES = 5  # chosen: no double contours at a metre
STILL_MPS, STILL_RADPS = 0.02, 0.02  # slower is at rest; chosen: less than a pixel

Motion = tuple[float, float, float]  # m/s along x and y of the world, rad/s


def poses_of(pose: Pose2, motion: Motion, level: float) -> list[Pose2]:
    """Poses during the exposure, the present one first; one pose at level 0 or at rest."""
    still = np.hypot(motion[0], motion[1]) < STILL_MPS and abs(motion[2]) < STILL_RADPS
    if level == 0.0 or still:
        return [pose]
    ago = [level * EXPOSURE_S * k / (PICTURES - 1) for k in range(PICTURES)]
    return [(pose[0] - motion[0] * t, pose[1] - motion[1] * t, pose[2] - motion[2] * t) for t in ago]


def mean_picture(pictures: list[Image]) -> Image:
    """Mean of pictures of one size; a single one is returned as it is."""
    if len(pictures) == 1:
        return pictures[0]
    total = np.zeros(pictures[0].shape, np.uint16)
    for picture in pictures:
        total += picture
    return np.asarray((total + len(pictures) // 2) // len(pictures), np.uint8)
