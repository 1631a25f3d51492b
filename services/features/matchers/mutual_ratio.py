"""Mutual nearest neighbours that are clearly nearer than the second nearest (Lowe 2004, section 7.1)."""

from collections.abc import Sequence

import numpy as np

from services.features.matching.nearest_neighbours import Neighbours, match_by
from services.features.pipeline.interfaces import Distance, FeatureSet, IndexArray, Profile


class MutualRatio:
    """Both are each other's nearest, and first distance < ratio x second distance."""

    def __init__(self, profile: Profile, distance: Distance) -> None:
        self._distance = distance
        # Squared Euclidean distances of +1/-1 vectors are proportional to the Hamming distance itself.
        self._ratio = profile.ratio if distance == "hamming" else profile.ratio**2

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[IndexArray]:
        """(M, 2) index pairs per other, in the order of the query."""

        def clearly_nearest(found: Neighbours) -> IndexArray:
            return np.flatnonzero(found.mutual & (found.first < self._ratio * found.second))

        return match_by(clearly_nearest, query, others, self._distance)
