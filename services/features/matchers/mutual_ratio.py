"""Mutual nearest neighbours that are clearly nearer than the second nearest (Lowe 2004, section 7.1)."""

from collections.abc import Sequence

import numpy as np

from services.features.matching.nearest_neighbours import Neighbours, match_by
from services.features.pipeline.interfaces import Distance, FeatureSet, IndexArray, Matched, Profile


class MutualRatio:
    """Both are each other's nearest, and first distance < ratio x second distance."""

    def __init__(self, profile: Profile, distance: Distance) -> None:
        self._distance, self._ratio = distance, profile.ratio

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame."""

        def clearly_nearest(found: Neighbours) -> IndexArray:
            return np.flatnonzero(found.mutual & (found.ratio(self._distance) < self._ratio))

        return match_by(clearly_nearest, query, others, self._distance)
