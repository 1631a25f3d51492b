"""The nodes of a map by their global descriptors: exact search by one matrix product.

At 100,000 nodes the product takes less time than verifying one node does (`topnav study scale`), so no
approximate index is needed.
"""

from collections.abc import Callable

import numpy as np

from services.features.pipeline.interfaces import Float32Array
from services.features.retrieval.global_descriptor import RetrievalModel, learn

LEARN_FROM = 128
"""Smaller maps are searched node by node, in 30 ms (nearest_neighbours.BATCH)."""
LEARN_FROM_MOST = 1024
"""Nodes that suffice: with them `topnav study scale` finds the node of every picture among 100,000."""
SEED = 20_100
"""Of the draws; any: the same map gives the same index."""


class NodeIndex:
    """Global descriptors by slot; learned anew whenever the map has doubled, until it knows enough.

    Args:
        vectors_of: descriptors of the node in a slot, (N, D) float32.
    """

    def __init__(self, vectors_of: Callable[[int], Float32Array]) -> None:
        self._vectors_of = vectors_of
        self._model: RetrievalModel | None = None
        self._rows = np.zeros((0, 0), np.float32)
        self._handicap = np.zeros(0, np.float32)
        self._slots: dict[int, None] = {}
        self._pending: dict[int, None] = {}

    @property
    def size_bytes(self) -> int:
        """Room taken by the global descriptors."""
        return self._rows.nbytes

    def put(self, slot: int) -> None:
        """A node is in this slot, new or changed."""
        self._slots[slot] = self._pending[slot] = None

    def remove(self, slot: int) -> None:
        """The slot is empty."""
        self._slots.pop(slot, None)
        self._pending.pop(slot, None)
        if slot < len(self._rows):
            self._handicap[slot] = -np.inf

    def nearest(self, query: Float32Array, count: int) -> list[int] | None:
        """Slots of the `count` most similar nodes, best first; None where the map is too small to ask."""
        if count >= len(self._slots) or not self.prepare():
            return None
        assert self._model is not None
        similarity = self._rows @ self._model.describe(query)
        similarity += self._handicap
        best = np.sort(np.argpartition(-similarity, count)[:count])
        return [int(slot) for slot in best[np.argsort(-similarity[best], kind="stable")]]

    def prepare(self) -> bool:
        """Learn and describe what is due; False while the map is too small."""
        known = 0 if self._model is None else self._model.learned_from
        if known < LEARN_FROM_MOST and len(self._slots) >= max(LEARN_FROM, 2 * known):
            self._learn()
        if self._model is None:
            return False
        for slot in self._pending:
            self._describe(slot, self._model)
        self._pending.clear()
        return True

    def _learn(self) -> None:
        slots = np.array(sorted(self._slots))
        rng = np.random.default_rng(SEED)
        chosen = np.sort(rng.choice(slots, min(LEARN_FROM_MOST, len(slots)), replace=False))
        self._model = learn([self._vectors_of(int(slot)) for slot in chosen], rng)
        self._rows = np.zeros((0, self._model.basis.shape[1]), np.float32)
        self._handicap = np.zeros(0, np.float32)
        self._pending = dict.fromkeys(self._slots)

    def _describe(self, slot: int, model: RetrievalModel) -> None:
        if slot >= len(self._rows):
            more = max(slot + 1, 2 * len(self._rows)) - len(self._rows)
            self._rows = np.concatenate([self._rows, np.zeros((more, self._rows.shape[1]), np.float32)])
            self._handicap = np.concatenate([self._handicap, np.full(more, -np.inf, np.float32)])
        self._rows[slot] = model.describe(self._vectors_of(slot))
        self._handicap[slot] = 0.0
