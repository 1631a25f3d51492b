"""Sensor noise: photons are counted (shot noise) and the counter errs (read noise), both before gamma. Pure.

A pixel of gamma-encoded value v collects n = FULL (v / 255)^2.2 electrons; n varies by sqrt(n + read^2).
"""

import cv2
import numpy as np
import numpy.typing as npt

from simulator.sensors.panorama import Image

GAMMA = 2.2  # of the picture
FEW_ELECTRONS = 50.0  # full pixel at level 1; level 0.5 has four times as many
READ_ELECTRONS = 2.5  # as of common sensors


def spread(level: float) -> npt.NDArray[np.float32]:
    """Standard deviation of each gamma-encoded value 0..255, in grey levels, (256,)."""
    full = FEW_ELECTRONS / level**2
    share = (np.arange(256) / 255.0) ** GAMMA
    error = np.sqrt(share * full + READ_ELECTRONS**2) / full
    # Slope of the gamma curve; near black the noise itself lifts the value to where the curve is less steep.
    slope = (1.0 / GAMMA) * (share + error) ** (1.0 / GAMMA - 1.0)
    return np.asarray(255.0 * error * slope, np.float32)


def noisy(picture: Image, level: float, rng: np.random.Generator) -> Image:
    """Add noise to a picture; level 0 returns it as it is."""
    if level == 0.0:
        return picture
    deviation = spread(level)[picture]
    deviation *= rng.standard_normal(picture.shape, np.float32)
    return np.asarray(cv2.add(picture, deviation, dtype=cv2.CV_8U), np.uint8)
