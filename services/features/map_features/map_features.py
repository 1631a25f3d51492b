"""The features of one map's nodes, packed, and an index to find nodes by."""

from typing import Self

from services.features.map_features.packing import Packing
from services.features.map_features.records import NodeRecords
from services.features.matching.nearest_neighbours import as_vectors
from services.features.matching.verification import feature_set
from services.features.pipeline.interfaces import Distance, FeatureSet, Float32Array
from services.features.pipeline.pipeline import Pipeline
from services.features.retrieval.index import NodeIndex
from shared.messages.features import Features


class MapFeatures:
    """Features by node id. A node of another pipeline is known by its pipeline only: it cannot be compared.

    Args:
        pipeline: identity of the pipeline in use.
        keypoints: most keypoints of a node.
        distance: of its descriptors.
    """

    def __init__(self, pipeline: str, keypoints: int, distance: Distance) -> None:
        self._pipeline, self._keypoints, self._distance = pipeline, keypoints, distance
        self._records: NodeRecords | None = None
        self._slots: dict[int, int] = {}
        self._nodes: dict[int, int] = {}
        self._free: list[int] = []
        self._others: dict[int, str] = {}
        self._index = NodeIndex(self._vectors_of)

    @classmethod
    def of(cls, pipeline: Pipeline) -> Self:
        """No nodes yet, for those that a pipeline makes."""
        return cls(pipeline.identity, pipeline.profile.keypoints, pipeline.extractor.distance)

    def __len__(self) -> int:
        return len(self._slots) + len(self._others)

    def __contains__(self, node_id: int) -> bool:
        return node_id in self._slots or node_id in self._others

    @property
    def ids(self) -> list[int]:
        """Node ids that can be compared, ascending."""
        return sorted(self._slots)

    @property
    def of_other_pipelines(self) -> dict[int, str]:
        """Node ids made by other pipelines, with the pipeline."""
        return dict(self._others)

    @property
    def size_bytes(self) -> int:
        """Room taken by features and index; of the features only those in use are in memory."""
        return (self._records.size_bytes if self._records else 0) + self._index.size_bytes

    def put(self, node_id: int, features: Features) -> None:
        """Add a node or replace it.

        Raises:
            ValueError: descriptors of another kind under the same pipeline's name.
        """
        self.remove(node_id)
        if features.pipeline != self._pipeline:
            self._others[node_id] = features.pipeline
            return
        kept = feature_set(features)
        if self._records is None:
            self._records = NodeRecords(Packing.of(kept, self._keypoints, self._distance))
        slot = self._free[-1] if self._free else len(self._slots)
        self._records.put(slot, kept)
        if self._free:
            self._free.pop()
        self._slots[node_id], self._nodes[slot] = slot, node_id
        self._index.put(slot)

    def remove(self, node_id: int) -> None:
        """Forget a node; one that is not there is no matter."""
        self._others.pop(node_id, None)
        slot = self._slots.pop(node_id, None)
        if slot is not None:
            del self._nodes[slot]
            self._free.append(slot)
            self._index.remove(slot)

    def features(self, node_id: int) -> FeatureSet:
        """Features of a node; KeyError for one that is not there or cannot be compared."""
        slot = self._slots[node_id]
        assert self._records is not None
        return self._records.get(slot)

    def nearest(self, query: FeatureSet, count: int) -> list[int]:
        """The `count` nodes that resemble the query most; all of them in a small map."""
        slots = self._index.nearest(as_vectors(query.descriptors, self._distance), count)
        return self.ids if slots is None else [self._nodes[slot] for slot in slots]

    def prepare(self) -> None:
        """Do now what the first question would otherwise wait for."""
        self._index.prepare()

    def _vectors_of(self, slot: int) -> Float32Array:
        assert self._records is not None
        return as_vectors(self._records.get(slot).descriptors, self._distance)
