"""Every descriptor with its nearest in the other frame, nothing refused: the thesis's baseline."""

from collections.abc import Sequence

import numpy as np

from services.features.matching.nearest_neighbours import Neighbours, match_by
from services.features.pipeline.interfaces import Distance, FeatureSet, IndexArray, Matched, Profile


class BruteForce:
    """Nearest neighbour; of several that share one, the closest keeps it."""

    def __init__(self, profile: Profile, distance: Distance) -> None:
        del profile
        self._distance = distance

    def match(self, query: FeatureSet, others: Sequence[FeatureSet]) -> list[Matched]:
        """Matches with each other frame."""
        return match_by(_closest, query, others, self._distance)


def _closest(found: Neighbours) -> IndexArray:
    """Of the rows that share a nearest descriptor, the closest one."""
    order = np.argsort(found.first, kind="stable")
    _, first = np.unique(found.nearest[order], return_index=True)
    return np.sort(order[first])
