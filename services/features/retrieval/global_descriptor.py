"""Global descriptors: one short vector per panorama, learned from the map itself, without weights. Pure.

The descriptors of some nodes are clustered into kinds. A panorama's VLAD (Jegou et al. 2010) tells how its
descriptors lie around the centres of their kinds, with unit residuals and with each kind of unit length ("All
about VLAD", Arandjelovic and Zisserman 2013); of it the principal directions of the nodes are kept. It knows
nothing of where keypoints lie, so turning the camera does not change it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from services.features.pipeline.interfaces import Float32Array

# What these give together, recall, time and room from 100 to 100,000 nodes, `topnav study scale` measures.
KINDS = 64
"""Centres, as many as in the papers."""
SAMPLE = 20_000
"""Descriptors clustered: 300 per kind."""
ROUNDS = 10
"""Iterations of k-means."""
DIMENSIONS = 256
"""Principal directions kept: 1 kB per node."""
WEAK = 1e-6
"""Share of the largest eigenvalue below which a direction is rounding."""
TINY = np.float32(1e-9)
"""Keeps the length of a zero vector from being divided by."""


@dataclass(frozen=True, eq=False)
class RetrievalModel:
    """What was learned from some nodes of a map.

    Attributes:
        kinds: (K, D) centres of the descriptors' kinds.
        mean: (K * D,) mean VLAD.
        basis: (K * D, d) principal directions, d <= DIMENSIONS.
        learned_from: number of nodes.
    """

    kinds: Float32Array
    mean: Float32Array
    basis: Float32Array
    learned_from: int

    def describe(self, vectors: Float32Array) -> Float32Array:
        """Unit global descriptor, (d,), of (N, D) descriptors as vectors."""
        return unit(np.asarray((_vlad(vectors, self.kinds) - self.mean) @ self.basis, dtype=np.float32))


def learn(nodes: Sequence[Float32Array], rng: np.random.Generator) -> RetrievalModel:
    """Learn from the descriptors (N_i, D) of some nodes.

    Raises:
        ValueError: too few descriptors.
    """
    kinds = _learn_kinds(nodes, rng)
    vlads = np.stack([_vlad(node, kinds) for node in nodes])
    mean = vlads.mean(axis=0)
    centred = vlads - mean
    # With fewer nodes than dimensions the small matrix of their products has the same directions.
    values, vectors = np.linalg.eigh(centred @ centred.T)
    strongest = np.argsort(-values)[: min(DIMENSIONS, len(nodes) - 1)]
    kept = strongest[values[strongest] > values[strongest[0]] * WEAK]
    basis = centred.T @ (vectors[:, kept] / np.sqrt(values[kept])).astype(np.float32)
    return RetrievalModel(kinds, mean, np.ascontiguousarray(basis), len(nodes))


def unit(rows: npt.NDArray[np.float32]) -> Float32Array:
    """Each vector along the last axis with length one; zero stays zero."""
    lengths: Float32Array = np.sqrt(np.einsum("...d,...d->...", rows, rows))[..., None]
    return np.asarray(rows / np.maximum(lengths, TINY), dtype=np.float32)


def _learn_kinds(descriptors: Sequence[Float32Array], rng: np.random.Generator) -> Float32Array:
    """Centres of k-means, (KINDS, D), over at most SAMPLE of the descriptors (N_i, D)."""
    everything = np.concatenate(descriptors)
    if len(everything) < KINDS:
        raise ValueError(f"at least {KINDS} descriptors are needed to learn from, got {len(everything)}")
    chosen = rng.choice(len(everything), min(SAMPLE, len(everything)), replace=False)
    cv2.setRNGSeed(int(rng.integers(2**31)))
    criteria = (cv2.TERM_CRITERIA_MAX_ITER, ROUNDS, 0.0)
    _, _, centres = cv2.kmeans(everything[chosen], KINDS, None, criteria, 1, cv2.KMEANS_PP_CENTERS)
    return np.asarray(centres, dtype=np.float32)


def _vlad(vectors: Float32Array, kinds: Float32Array) -> Float32Array:
    """Aggregate (N, D) descriptors around (K, D) centres into a unit vector (K * D,); zero without any."""
    distances = np.einsum("kd,kd->k", kinds, kinds) - np.float32(2.0) * (vectors @ kinds.T)
    nearest = distances.argmin(axis=1)
    belongs = np.zeros((len(kinds), len(vectors)), dtype=np.float32)
    belongs[nearest, np.arange(len(vectors))] = 1.0
    sums = belongs @ unit(vectors - kinds[nearest])
    return unit(unit(sums).reshape(-1))
