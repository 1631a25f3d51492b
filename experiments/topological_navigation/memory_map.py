"""A map in this process, and its file: the archive that `topnav map export` writes."""

from collections.abc import Sequence
from pathlib import Path

from services.map_store.errors import MapError
from services.map_store.storage.archive import Archive, write_archive
from services.map_store.storage.blobs import checksum, pack_features, unpack_features
from services.map_store.storage.contents import Kind
from services.map_store.storage.graph import AddStoredNode, Graph, StoredNode
from services.planner.ports import RightOfWay
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.rules import NO_LIMITS, Limits
from shared.messages.features import Features
from shared.messages.maps import AddNode, Operation, PutEdge

MAX_BYTES = 2_000_000_000  # unpacked: 80,000 nodes of 23 kB


class MemoryMap:
    """Graph and features; what a mission needs of a map."""

    shared = False

    def __init__(self) -> None:
        self.graph = MapGraph()
        self.features: dict[int, Features] = {}

    def limits(self) -> Limits:
        """A map of an experiment has no rules."""
        return NO_LIMITS

    def commit(self, operations: Sequence[Operation]) -> None:
        """Change the graph; new nodes bring their features."""
        self.graph.apply(operations)
        for operation in operations:
            if isinstance(operation, AddNode):
                self.features[operation.node.node_id] = operation.features

    def features_of(self, node_id: int) -> Features:
        """What a node looks like."""
        return self.features[node_id]

    def right_of_way(self, _at: Sequence[int], ahead: Sequence[int]) -> RightOfWay:
        """Nobody else drives in it."""
        return RightOfWay(len(ahead))


def save(maps: MemoryMap, path: Path) -> None:
    """Write the map; the same map gives the same bytes."""
    packed = {node_id: pack_features(maps.features[node_id]) for node_id in maps.graph.nodes}
    nodes = {
        node_id: StoredNode(node=node, features=checksum(packed[node_id]))
        for node_id, node in maps.graph.nodes.items()
    }

    def blob(stored: StoredNode, kind: Kind) -> bytes:
        del kind  # thumbnails are not kept here
        return packed[stored.node_id]

    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(path.name + ".new")
    with new.open("wb") as file:
        write_archive(file, path.stem, 0, Graph(nodes=nodes, edges=dict(maps.graph.edges)), blob)
    new.replace(path)


def load(path: Path) -> MemoryMap:
    """Read a map.

    Raises:
        ValueError: it is no such archive, or a pickle, which could run any code when opened.
    """
    if path.suffix in (".pickle", ".pkl"):
        raise ValueError(
            f"{path} is a pickle, which may run any code when it is opened: export a .zip instead"
        )
    maps = MemoryMap()
    try:
        with path.open("rb") as file:
            archive = Archive(file, MAX_BYTES)
            for step in archive.steps:
                if isinstance(step, AddStoredNode):
                    maps.graph.nodes[step.place.node_id] = step.place.node
                    maps.features[step.place.node_id] = unpack_features(archive.blob(step.place.features))
                elif isinstance(step, PutEdge):
                    maps.graph.edges[step.edge.a, step.edge.b] = step.edge
    except (OSError, MapError) as error:
        raise ValueError(f"{path} is no map: {error}") from error
    return maps
