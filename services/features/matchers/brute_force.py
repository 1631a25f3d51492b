"""Every descriptor with its nearest in the other frame, nothing refused: the thesis's baseline."""

from collections.abc import Sequence

import numpy as np

from services.features.matching.nearest_neighbours import find_neighbours
from services.features.pipeline.interfaces import Distance, FeatureSet, IndexArray
from services.features.pipeline.named_pipelines import Profile


class BruteForce:
    """Nearest neighbour; of several that share one, the closest keeps it."""

    def __init__(self, profile: Profile, distance: Distance) -> None:
        del profile
        self._distance = distance

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[IndexArray]:
        """(M, 2) index pairs per other, in the order of the query."""
        pairs = []
        for found in find_neighbours(
            query.descriptors, [other.descriptors for other in others], self._distance
        ):
            if found is None:
                pairs.append(np.zeros((0, 2), dtype=np.intp))
                continue
            order = np.argsort(found.first, kind="stable")
            _, first = np.unique(found.nearest[order], return_index=True)
            rows = np.sort(order[first])
            pairs.append(np.stack([rows, found.nearest[rows]], axis=1))
        return pairs
