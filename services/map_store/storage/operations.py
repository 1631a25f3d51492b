"""Operations of the bus as the store keeps them, and as everyone else gets to see them. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass

from services.map_store.storage.blobs import checksum, pack_features
from services.map_store.storage.graph import AddStoredNode, Step, StoredNode
from shared.messages.maps import AddNode, Operation


@dataclass(frozen=True)
class Prepared:
    """One transaction, ready to be applied.

    Attributes:
        steps: for the graph.
        contents: checksum -> bytes of every blob that the steps name.
        published: the operations without thumbnails, which followers fetch over REST if they want them.
    """

    steps: tuple[Step, ...]
    contents: dict[str, bytes]
    published: tuple[Operation, ...]


def prepare(operations: Sequence[Operation]) -> Prepared:
    """Take the pictures out of `operations`."""
    steps: list[Step] = []
    published: list[Operation] = []
    contents: dict[str, bytes] = {}
    for operation in operations:
        if not isinstance(operation, AddNode):
            steps.append(operation)
            published.append(operation)
            continue
        features, thumbnail = pack_features(operation.features), operation.features.thumbnail
        stored = StoredNode(
            node=operation.node,
            features=checksum(features),
            thumbnail=checksum(thumbnail) if thumbnail else "",
        )
        contents |= dict(zip(stored.blobs, (features, thumbnail), strict=False))
        steps.append(AddStoredNode(place=stored))
        bare = operation.features.model_copy(update={"thumbnail": b""})
        published.append(operation.model_copy(update={"features": bare}))
    return Prepared(tuple(steps), contents, tuple(published))
