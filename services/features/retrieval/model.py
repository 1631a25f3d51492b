"""From words to a short global descriptor: VLAD, then the directions in which places differ. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from services.features.pipeline.interfaces import Float32Array
from services.features.retrieval.vlad import unit, vlad
from services.features.retrieval.vocabulary import learn_kinds

DIMENSIONS = 256


@dataclass(frozen=True, eq=False)
class RetrievalModel:
    """What was learned from some places of a map.

    Attributes:
        kinds: (K, D) centres of the descriptors' kinds.
        mean: (K * D,) mean VLAD.
        basis: (K * D, d) principal directions, d <= DIMENSIONS.
        learned_from: number of places.
    """

    kinds: Float32Array
    mean: Float32Array
    basis: Float32Array
    learned_from: int

    def describe(self, vectors: Float32Array) -> Float32Array:
        """Unit global descriptor, (d,), of (N, D) descriptors as vectors."""
        return unit(np.asarray((vlad(vectors, self.kinds) - self.mean) @ self.basis, dtype=np.float32))


def learn(places: Sequence[Float32Array], rng: np.random.Generator) -> RetrievalModel:
    """Learn from the descriptors of some places.

    Raises:
        ValueError: too few descriptors.
    """
    kinds = learn_kinds(places, rng)
    vlads = np.stack([vlad(place, kinds) for place in places])
    mean = vlads.mean(axis=0)
    centred = vlads - mean
    # With fewer places than dimensions the small matrix of their products has the same directions.
    values, vectors = np.linalg.eigh(centred @ centred.T)
    strongest = np.argsort(-values)[: min(DIMENSIONS, len(places) - 1)]
    kept = strongest[values[strongest] > values[strongest[0]] * 1e-6]
    basis = centred.T @ (vectors[:, kept] / np.sqrt(values[kept])).astype(np.float32)
    return RetrievalModel(kinds, mean, np.ascontiguousarray(basis), len(places))
