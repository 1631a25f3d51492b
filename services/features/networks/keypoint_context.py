"""What our networks are told of a keypoint beside its descriptor and where it is. Pure."""

import numpy as np

from services.features.pipeline.interfaces import FeatureSet, Float32Array

CONTEXT = 4
"""Numbers of a keypoint."""
SIZE_RAD, SCORE = 0.05, 0.1
"""Typical size and strength of SIFT's keypoints, so that their logarithms are about 0."""


def context_of(features: FeatureSet) -> Float32Array:
    """(N, 4): sine of the latitude and its square, and logarithms of size and strength."""
    sizes = np.full(len(features), SIZE_RAD) if features.sizes_rad is None else features.sizes_rad
    height = np.sin(features.lonlat_rad[:, 1])
    columns = (
        height,
        height**2,
        np.log(np.maximum(sizes, 1e-4) / SIZE_RAD),
        np.log(np.maximum(features.scores, 1e-6) / SCORE),
    )
    return np.stack(columns, axis=-1).astype(np.float32)
