"""Panoramas of coloured blobs as large as furniture, which go on across the seam."""

import cv2
import numpy as np


def blobs(width_px, blob_px, seed):
    """(H, 2H, 3) BGR."""
    shape = (width_px // 2 // blob_px, width_px // blob_px, 3)
    noise = np.random.default_rng(seed).integers(0, 256, shape, dtype=np.uint8)
    round_about = np.concatenate([noise, noise, noise], axis=1)
    wide = cv2.resize(round_about, (3 * width_px, width_px // 2), interpolation=cv2.INTER_CUBIC)
    return np.ascontiguousarray(wide[:, width_px : 2 * width_px])
