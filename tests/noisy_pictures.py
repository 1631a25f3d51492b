"""Pictures as a camera's sensor gives them: no two alike, even of a scene where nothing moves."""

import cv2
import numpy as np


class NoisyPictures:
    """JPEGs of one panorama, (H, 2H, 3) BGR, each with noise of its own. Call it with a time."""

    def __init__(self, panorama: np.ndarray, sigma: float = 2.0, seed: int = 0) -> None:
        self.panorama, self._sigma, self._rng = panorama, sigma, np.random.default_rng(seed)

    def __call__(self, now_s: float = 0.0) -> bytes:
        del now_s
        noise = self._rng.normal(0.0, self._sigma, self.panorama.shape)
        noisy = np.clip(self.panorama + noise, 0.0, 255.0).astype(np.uint8)
        return cv2.imencode(".jpg", noisy, [cv2.IMWRITE_JPEG_QUALITY, 90])[1].tobytes()


def painted(width_px: int = 256) -> np.ndarray:
    """A panorama of coloured patches with a red spot ahead and a blue one to the left, (W / 2, W, 3) BGR."""
    height_px = width_px // 2
    rng = np.random.default_rng(5)
    patches = rng.integers(60, 200, (height_px // 16, width_px // 16, 3), dtype=np.uint8)
    picture = cv2.resize(patches, (width_px, height_px), interpolation=cv2.INTER_CUBIC)
    cv2.circle(picture, (width_px // 2, height_px // 2), width_px // 32, (0, 0, 255), -1)
    cv2.circle(picture, (width_px // 4, height_px // 2), width_px // 32, (255, 0, 0), -1)
    return picture
