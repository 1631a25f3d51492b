"""Other light and a camera's noise on rendered pictures. Pure."""

import cv2
import numpy as np

from simulator.simulation import Image

TINT = 0.08
"""By how much each colour channel is brighter or darker; chosen: lamps of another kind."""
NOISE_LEVELS = 2.0
"""Standard deviation of each pixel; chosen: a good camera indoors."""
QUALITY = 85
"""JPEG, as pictures are kept."""


def photographed(picture: Image, brightness: float, rng: np.random.Generator) -> Image:
    """A picture in other light, noisy, through JPEG.

    Args:
        picture: (H, W, 3) BGR.
        brightness: factor for all pixel values.
        rng: draws tint and noise.
    """
    gain = brightness * rng.uniform(1.0 - TINT, 1.0 + TINT, 3)
    noisy = picture * gain + NOISE_LEVELS * rng.standard_normal(picture.shape)
    bytes_ = np.clip(noisy.round(), 0, 255).astype(np.uint8)
    _, encoded = cv2.imencode(".jpg", bytes_, (cv2.IMWRITE_JPEG_QUALITY, QUALITY))
    return np.asarray(cv2.imdecode(encoded, cv2.IMREAD_COLOR), np.uint8)
