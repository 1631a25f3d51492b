"""Words of all places of the maps asked for, filled once and then kept by deltas."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from services.features.places.places import Places
from shared.messages.maps import AddNode, DeleteNode, MapDelta, NodeFeatures


@dataclass
class MapWords:
    """One map at one revision."""

    revision: int
    places: Places


class MapCache:
    """Maps by name. A map whose deltas leave a gap is dropped, to be read again when next asked for.

    Args:
        empty: makes the places of a new map.
    """

    def __init__(self, empty: Callable[[], Places]) -> None:
        self._empty = empty
        self._maps: dict[str, MapWords] = {}

    def get(self, name: str) -> MapWords | None:
        """The map as far as it is known, None when it must be read."""
        return self._maps.get(name)

    def load(self, name: str, revision: int, features: Iterable[NodeFeatures]) -> MapWords:
        """Take over a whole map, place by place."""
        words = MapWords(revision, self._empty())
        for part in features:
            words.places.put(part.node_id, part.features)
        words.places.prepare()
        self._maps[name] = words
        return words

    def drop(self, name: str) -> None:
        """Forget a map."""
        self._maps.pop(name, None)

    def apply(self, delta: MapDelta) -> None:
        """Follow one change of a map that is kept; changes already in it are skipped."""
        words = self._maps.get(delta.map)
        if words is None:
            return
        if delta.reset:
            self.drop(delta.map)
            return
        if delta.revision <= words.revision:
            return
        if delta.revision > words.revision + 1:
            self.drop(delta.map)
            return
        for operation in delta.operations:
            if isinstance(operation, AddNode):
                words.places.put(operation.node.node_id, operation.features)
            elif isinstance(operation, DeleteNode):
                words.places.remove(operation.node_id)
        words.revision = delta.revision
