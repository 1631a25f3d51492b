"""Words of all places of the maps asked for, filled once and then kept by deltas. Pure."""

from dataclasses import dataclass, field

from services.features.interfaces import FeatureSet
from services.features.verification import feature_set
from shared.messages.features import Features
from shared.messages.maps import AddNode, DeleteNode, MapDelta, MapReply


@dataclass(frozen=True, eq=False)
class Place:
    """Words of one node and the pipeline that made them."""

    pipeline: str
    features: FeatureSet

    @classmethod
    def of(cls, features: Features) -> "Place":
        """Keep what matching needs; thumbnails are left behind."""
        return cls(features.pipeline, feature_set(features))


@dataclass
class MapWords:
    """One map at one revision."""

    revision: int
    places: dict[int, Place] = field(default_factory=dict)


class MapCache:
    """Maps by name. A map whose deltas leave a gap is dropped, to be read again when next asked for."""

    def __init__(self) -> None:
        self._maps: dict[str, MapWords] = {}

    def get(self, name: str) -> MapWords | None:
        """The map as far as it is known, None when it must be read."""
        return self._maps.get(name)

    def load(self, reply: MapReply) -> MapWords:
        """Take over a whole map."""
        words = MapWords(reply.revision, {part.node_id: Place.of(part.features) for part in reply.features})
        self._maps[reply.map] = words
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
                words.places[operation.node.node_id] = Place.of(operation.features)
            elif isinstance(operation, DeleteNode):
                words.places.pop(operation.node_id, None)
        words.revision = delta.revision
