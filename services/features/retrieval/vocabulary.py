"""Kinds of descriptors, learned from the map itself: any pipeline has them, none needs weights. Pure."""

from collections.abc import Sequence

import cv2
import numpy as np

from services.features.pipeline.interfaces import Float32Array

KINDS = 64
SAMPLE = 20_000
ROUNDS = 10


def learn_kinds(descriptors: Sequence[Float32Array], rng: np.random.Generator) -> Float32Array:
    """Centres of k-means, (KINDS, D), over at most SAMPLE of the descriptors (N_i, D).

    Raises:
        ValueError: fewer descriptors than kinds.
    """
    everything = np.concatenate(descriptors)
    if len(everything) < KINDS:
        raise ValueError(f"at least {KINDS} descriptors are needed to learn from, got {len(everything)}")
    chosen = rng.choice(len(everything), min(SAMPLE, len(everything)), replace=False)
    cv2.setRNGSeed(int(rng.integers(2**31)))
    criteria = (cv2.TERM_CRITERIA_MAX_ITER, ROUNDS, 0.0)
    _, _, centres = cv2.kmeans(everything[chosen], KINDS, None, criteria, 1, cv2.KMEANS_PP_CENTERS)
    return np.asarray(centres, dtype=np.float32)
