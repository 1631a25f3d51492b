"""What a user would pick instead to find a node: each ranks all nodes of a map for one picture.

Plain descriptors against all nodes (OpenCV, kornia), a bag of visual words (Sivic and Zisserman 2003) and
VLAD alone, without the verification of geometry that topnav ends with.
"""

import time
from collections.abc import Callable, Sequence

import cv2
import numpy as np
import torch
from kornia.feature import match_smnn

from services.features.matching.nearest_neighbours import as_vectors
from services.features.pipeline.interfaces import FeatureSet, Float32Array
from services.features.retrieval.global_descriptor import learn, unit

RATIO = 0.85
"""Of the default pipeline's own matcher, so that all see the same matches."""

BAG_WORDS, BAG_SAMPLE = 1000, 40_000
"""Clusters, and descriptors they are learned from: forty a cluster, where k-means no longer changes much."""

Rank = Callable[[FeatureSet], int]
"""The number of the node that resembles a picture most."""


def peers(nodes: Sequence[FeatureSet]) -> dict[str, Rank]:
    """Each way by name, ready for pictures."""
    return {
        "OpenCV BFMatcher, ratio test": _brute_force(nodes),
        "kornia match_smnn": _smnn(nodes),
        f"bag of {BAG_WORDS} visual words": _bag(nodes),
        "VLAD alone": _vlad(nodes),
    }


def timed(rank: Rank, queries: Sequence[FeatureSet]) -> tuple[list[int], float]:
    """Answers, and the median milliseconds."""
    answers, ms = [], []
    for query in queries:
        start_s = time.perf_counter()
        answers.append(rank(query))
        ms.append((time.perf_counter() - start_s) * 1e3)
    return answers, float(np.median(ms))


def _brute_force(nodes: Sequence[FeatureSet]) -> Rank:
    matcher = cv2.BFMatcher(cv2.NORM_L2)
    floats = [as_vectors(each.descriptors, "euclidean") for each in nodes]

    def rank(query: FeatureSet) -> int:
        own = as_vectors(query.descriptors, "euclidean")
        counts = [
            sum(
                len(two) == 2 and two[0].distance < RATIO * two[1].distance
                for two in matcher.knnMatch(own, each, k=2)
            )
            for each in floats
        ]
        return int(np.argmax(counts))

    return rank


def _smnn(nodes: Sequence[FeatureSet]) -> Rank:
    tensors = [torch.from_numpy(as_vectors(each.descriptors, "euclidean")) for each in nodes]

    def rank(query: FeatureSet) -> int:
        own = torch.from_numpy(as_vectors(query.descriptors, "euclidean"))
        with torch.inference_mode():
            return int(np.argmax([len(match_smnn(own, each, RATIO)[0]) for each in tensors]))

    return rank


def _bag(nodes: Sequence[FeatureSet]) -> Rank:
    vectors = [as_vectors(each.descriptors, "euclidean") for each in nodes]
    everything, rng = np.concatenate(vectors), np.random.default_rng(1)
    sample = everything[rng.choice(len(everything), min(BAG_SAMPLE, len(everything)), replace=False)]
    cv2.setRNGSeed(1)
    criteria = (cv2.TERM_CRITERIA_MAX_ITER, 10, 0.0)
    _, _, found = cv2.kmeans(sample, BAG_WORDS, None, criteria, 1, cv2.KMEANS_RANDOM_CENTERS)
    centres = np.asarray(found, dtype=np.float32)

    def counts(own: Float32Array) -> Float32Array:
        nearest = (np.einsum("kd,kd->k", centres, centres) - 2.0 * (own @ centres.T)).argmin(axis=1)
        return np.bincount(nearest, minlength=len(centres)).astype(np.float32)

    table = np.stack([counts(each) for each in vectors])
    rarity = np.log(len(table) / np.maximum((table > 0).sum(axis=0), 1)).astype(np.float32)
    table = unit(table * rarity)
    return lambda query: int(
        np.argmax(table @ unit(counts(as_vectors(query.descriptors, "euclidean")) * rarity))
    )


def _vlad(nodes: Sequence[FeatureSet]) -> Rank:
    vectors = [as_vectors(each.descriptors, "euclidean") for each in nodes]
    model = learn(vectors[:1024], np.random.default_rng(1))
    table = np.stack([model.describe(each) for each in vectors])
    return lambda query: int(np.argmax(table @ model.describe(as_vectors(query.descriptors, "euclidean"))))
