"""Nodes with four times the keypoints, out of their pictures: what ordinary photos are compared with. Pure.

A photo shows a tenth of the sphere, and thirty of the 300 keypoints by which frames are compared lie in it.
"""

from collections.abc import Iterable

from services.features.map_features.map_features import MapFeatures
from services.features.pipeline.pipeline import Pipeline
from services.features.pipeline.thumbnail import from_thumbnail

KEYPOINTS = 1200
"""Of a node; of 60 photos from anywhere in the apartment 52 are found with so many, 42 with 300."""
LEAST_SHARE = 0.75
"""Of the columns at which the pipeline looks at frames: the picture of a node that has fewer is of no use."""


class PicturedNodes:
    """Features of the nodes of one map that were asked for.

    Args:
        pipeline: extracts, and made the features by which frames are compared.
    """

    def __init__(self, pipeline: Pipeline) -> None:
        self._pipeline = pipeline
        self._keypoints = max(KEYPOINTS, pipeline.profile.keypoints)
        self.nodes = MapFeatures(pipeline.identity, self._keypoints, pipeline.extractor.distance)
        self._bare = set[int]()

    def missing(self, node_ids: Iterable[int]) -> list[int]:
        """Those of them whose pictures were not looked at yet."""
        return [n for n in node_ids if n not in self.nodes and n not in self._bare]

    def put(self, node_id: int, picture: bytes) -> None:
        """Look at the picture of a node: a JPEG, or b"" where it has none."""
        self.remove(node_id)
        image = from_thumbnail(picture)
        if image is None or image.shape[1] < LEAST_SHARE * self._pipeline.columns:
            self._bare.add(node_id)
        else:
            self.nodes.put(node_id, self._pipeline.features_of_picture(image, self._keypoints))

    def remove(self, node_id: int) -> None:
        """Forget a node; one that is not there is no matter."""
        self._bare.discard(node_id)
        self.nodes.remove(node_id)
