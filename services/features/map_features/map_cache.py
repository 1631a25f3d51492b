"""Features of all nodes of the maps asked for, filled once and then kept by deltas."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from services.features.map_features.map_features import MapFeatures
from services.features.map_features.pictured import PicturedNodes
from shared.messages.features import Features
from shared.messages.maps import AddNode, DeleteNode, MapDelta, NodeFeatures


@dataclass
class CachedMap:
    """One map at one revision.

    Attributes:
        pictured: nodes with what ordinary photos are compared with; None before the first.
    """

    revision: int
    nodes: MapFeatures
    pictured: PicturedNodes | None = None

    def put(self, node_id: int, features: Features) -> None:
        """Add a node or replace it."""
        self.nodes.put(node_id, features)
        self._forget_picture(node_id)

    def remove(self, node_id: int) -> None:
        """Forget a node."""
        self.nodes.remove(node_id)
        self._forget_picture(node_id)

    def _forget_picture(self, node_id: int) -> None:
        if self.pictured is not None:
            self.pictured.remove(node_id)


class MapCache:
    """Maps by name. A map whose deltas leave a gap is dropped, to be read again when next asked for.

    Args:
        empty: makes the features of a map without nodes.
    """

    def __init__(self, empty: Callable[[], MapFeatures]) -> None:
        self._empty = empty
        self._maps: dict[str, CachedMap] = {}

    def get(self, name: str) -> CachedMap | None:
        """The map as far as it is known, None when it must be read."""
        return self._maps.get(name)

    def load(self, name: str, revision: int, features: Iterable[NodeFeatures]) -> CachedMap:
        """Take over a whole map, node by node."""
        kept = CachedMap(revision, self._empty())
        for part in features:
            kept.put(part.node_id, part.features)
        kept.nodes.prepare()
        self._maps[name] = kept
        return kept

    def drop(self, name: str) -> None:
        """Forget a map."""
        self._maps.pop(name, None)

    def apply(self, delta: MapDelta) -> None:
        """Follow one change of a map that is kept; changes already in it are skipped."""
        kept = self._maps.get(delta.map)
        if kept is None:
            return
        if delta.reset:
            self.drop(delta.map)
            return
        if delta.revision <= kept.revision:
            return
        if delta.revision > kept.revision + 1:
            self.drop(delta.map)
            return
        for operation in delta.operations:
            if isinstance(operation, AddNode):
                kept.put(operation.node.node_id, operation.features)
            elif isinstance(operation, DeleteNode):
                kept.remove(operation.node_id)
        kept.revision = delta.revision
